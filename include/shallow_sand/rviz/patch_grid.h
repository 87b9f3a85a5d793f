#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "shallow_sand/HeightField.h"
#include "shallow_sand/client/height_field_map.h"
#include "shallow_sand/rviz/sand_vertices.h"

namespace shallow_sand {

/// How a map is cut into patches that are drawn one by one.
class PatchGrid {
 public:
  using Number = std::pair<std::uint32_t, std::uint32_t>;  // column, row of a patch
  /// Cells along a side of a patch: few enough that little is written for a small change, enough that the
  /// graphics card has something to do.
  static constexpr std::uint32_t kCells = 64;

  PatchGrid() = default;
  explicit PatchGrid(const HeightField& map) : columns_(map.columns), rows_(map.rows) {}

  /// Vertices of a patch, as cells of the map: it shares its last with the next one.
  CellRectangle verticesOf(const Number& patch) const {
    const std::uint32_t i = patch.first * kCells;
    const std::uint32_t j = patch.second * kCells;
    return {i, j, std::min(kCells + 1, columns_ - i), std::min(kCells + 1, rows_ - j)};
  }

  /// Patches with vertices that feel a change of these cells.
  std::vector<Number> touchedBy(const CellRectangle& cells) const {
    std::vector<Number> patches;
    for (std::uint32_t row = first(cells.row); row <= last(cells.row + cells.rows, rows_); ++row) {
      for (std::uint32_t column = first(cells.column); column <= last(cells.column + cells.columns, columns_);
           ++column)
        patches.emplace_back(column, row);
    }
    return patches;
  }

  bool isAtSide(const Number& patch) const {
    return patch.first == 0 || patch.second == 0 || patch.first + 1 == along(columns_) ||
           patch.second + 1 == along(rows_);
  }

 private:
  /// Patches along a side. The last cell of a map begins none, for it has no neighbour to span to.
  static std::uint32_t along(std::uint32_t cells) { return cells <= 1 ? 1 : (cells - 2) / kCells + 1; }
  static std::uint32_t first(std::uint32_t cell) {
    // Its first vertex belongs to the patch before, too.
    return cell > kReachOfVertices ? (cell - kReachOfVertices - 1) / kCells : 0;
  }
  static std::uint32_t last(std::uint32_t end, std::uint32_t of) {
    return std::min((end - 1 + kReachOfVertices) / kCells, along(of) - 1);
  }

  std::uint32_t columns_ = 0;
  std::uint32_t rows_ = 0;
};

}  // namespace shallow_sand
