#include "shallow_sand/core/moved_volume.h"

#include <algorithm>
#include <string>

#include "shallow_sand/core/parameters.h"

namespace shallow_sand {
namespace {

/// Depth of a cell's sand. [m]
struct CellSand {
  double below;  ///< no higher above the bed than some height
  double all;
};

CellSand sandBelow(double height, const Fields& fields, std::size_t cell) {
  const double ground = static_cast<double>(fields.depth[cell]);
  if (fields.load.empty()) return {std::min(ground, height), ground};
  const double load = static_cast<double>(fields.load[cell]);
  const double foot = static_cast<double>(fields.load_elevation[cell]) - fields.bed[cell];
  return {std::min(ground, height) + std::clamp(height - foot, 0.0, load), ground + load};
}

}  // namespace

MovedVolume movedVolume(const Grid& grid, const std::vector<float>& start, const Fields& now) {
  if (start.size() != now.depth.size()) {
    throw InvalidParameter("start", std::to_string(start.size()) + " values",
                           std::to_string(now.depth.size()) + ", one for each cell");
  }
  MovedVolume moved;
  for (std::size_t k = 0; k < start.size(); ++k) {
    const double before = static_cast<double>(start[k]);
    const CellSand sand = sandBelow(before, now, k);
    moved.dug += before - sand.below;
    moved.heaped += sand.all - sand.below;
  }
  moved.dug *= grid.cellArea();
  moved.heaped *= grid.cellArea();
  return moved;
}

}  // namespace shallow_sand
