#include "shallow_sand/core/moved_volume.h"

#include <cmath>
#include <string>

#include "shallow_sand/core/parameters.h"

namespace shallow_sand {

MovedVolume movedVolume(const Grid& grid, const std::vector<float>& start, const Fields& now) {
  if (start.size() != now.depth.size()) {
    throw InvalidParameter("start", std::to_string(start.size()) + " values",
                           std::to_string(now.depth.size()) + ", one for each cell");
  }
  MovedVolume moved;
  for (std::size_t k = 0; k < start.size(); ++k) {
    const double rise = static_cast<double>(now.depth[k]) - static_cast<double>(start[k]);
    (rise > 0.0 ? moved.heaped : moved.dug) += std::abs(rise);
  }
  moved.dug *= grid.cellArea();
  moved.heaped *= grid.cellArea();
  return moved;
}

}  // namespace shallow_sand
