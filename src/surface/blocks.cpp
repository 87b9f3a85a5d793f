#include "shallow_sand/surface/blocks.h"

#include <algorithm>

namespace shallow_sand {

namespace {

int blockCount(int cells, int level) { return (cells + (1 << level) - 1) >> level; }

/// Middles and sizes of the blocks along one axis.
void cutAxis(double origin, double spacing, int cells, int level, std::vector<double>& middles,
             std::vector<double>& sizes) {
  for (int block = 0; block < blockCount(cells, level); ++block) {
    const int begin = block << level;
    const int end = std::min(cells, begin + (1 << level));
    middles.push_back(origin + 0.5 * (begin + end) * spacing);
    sizes.push_back((end - begin) * spacing);
  }
}

/// The mean over each block. Value: of a cell's index.
template <class Value>
std::vector<float> means(const Grid& grid, int level, const Value& value) {
  const int columns = blockCount(grid.columns, level);
  const int rows = blockCount(grid.rows, level);
  std::vector<float> result;
  result.reserve(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  std::vector<double> sums(static_cast<std::size_t>(columns));
  for (int row = 0; row < rows; ++row) {
    std::fill(sums.begin(), sums.end(), 0.0);
    const int begin = row << level;
    const int end = std::min(grid.rows, begin + (1 << level));
    for (int j = begin; j < end; ++j) {
      for (int i = 0; i < grid.columns; ++i)
        sums[static_cast<std::size_t>(i >> level)] += static_cast<double>(value(grid.index(i, j)));
    }
    for (int column = 0; column < columns; ++column) {
      const int width = std::min(grid.columns, (column + 1) << level) - (column << level);
      result.push_back(static_cast<float>(sums[static_cast<std::size_t>(column)] / (width * (end - begin))));
    }
  }
  return result;
}

}  // namespace

Lattice blocksOf(const Grid& grid, int level) {
  Lattice lattice;
  const double spacing = static_cast<double>(grid.spacing);
  cutAxis(grid.origin_x, spacing, grid.columns, level, lattice.x, lattice.width);
  cutAxis(grid.origin_y, spacing, grid.rows, level, lattice.y, lattice.height);
  return lattice;
}

Fields blockMeans(const Grid& grid, const Fields& fields, int level) {
  Fields result;
  result.bed = means(grid, level, [&](std::size_t k) { return fields.bed[k]; });
  result.depth = means(grid, level, [&](std::size_t k) { return fields.depth[k]; });
  if (fields.load.empty()) return result;
  result.load = means(grid, level, [&](std::size_t k) { return fields.load[k]; });
  result.load_elevation = means(grid, level, [&](std::size_t k) {
    return static_cast<double>(fields.load[k]) * static_cast<double>(fields.load_elevation[k]);
  });
  for (std::size_t k = 0; k < result.load.size(); ++k)
    result.load_elevation[k] = result.load[k] > 0.0f ? result.load_elevation[k] / result.load[k] : 0.0f;
  return result;
}

int finestLevel(const Grid& grid, std::size_t most_blocks) {
  int level = 0;
  const auto blocks = [&] {
    return static_cast<std::size_t>(blockCount(grid.columns, level)) *
           static_cast<std::size_t>(blockCount(grid.rows, level));
  };
  while (blocks() > std::max<std::size_t>(most_blocks, 1)) ++level;
  return level;
}

}  // namespace shallow_sand
