#include "shallow_sand/solver/change_sand.h"

#include <algorithm>
#include <limits>

namespace shallow_sand {

LocalRegion localRegion(const Region& region, const Grid& grid) {
  LocalRegion local{};
  local.center_x = static_cast<float>(region.center.x() - grid.origin_x);
  local.center_y = static_cast<float>(region.center.y() - grid.origin_y);
  // What lies between the centres of cells is taken as the nearest ones.
  const bool disc = region.shape == Region::Shape::disc;
  local.radius = disc ? std::max(static_cast<float>(region.radius), 0.71f * grid.spacing) : -1.0f;
  local.half_x = std::max(static_cast<float>(0.5 * region.size.x()), 0.51f * grid.spacing);
  local.half_y = std::max(static_cast<float>(0.5 * region.size.y()), 0.51f * grid.spacing);
  return local;
}

LocalRegion wholeMap() {
  constexpr float kAll = std::numeric_limits<float>::infinity();
  return {0.0f, 0.0f, -1.0f, kAll, kAll};
}

Window windowOf(const LocalRegion& region, const Grid& grid) {
  const float x = region.radius >= 0.0f ? region.radius : region.half_x;
  const float y = region.radius >= 0.0f ? region.radius : region.half_y;
  return Window::around(region.center_x - x, region.center_y - y, region.center_x + x, region.center_y + y,
                        grid);
}

}  // namespace shallow_sand
