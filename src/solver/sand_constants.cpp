#include "shallow_sand/solver/sand_constants.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace shallow_sand {

SandConstants sandConstants(const Grid& grid, const Eigen::Vector3d& gravity, const Material& material) {
  const double spacing = grid.spacing;
  const double friction = std::tan(material.friction_angle);
  SandConstants sand;
  sand.spacing = grid.spacing;
  sand.gravity = static_cast<float>(-gravity.z());
  sand.gravity_x = static_cast<float>(gravity.x());
  sand.gravity_y = static_cast<float>(gravity.y());
  sand.level_x = static_cast<float>(-spacing * gravity.x() / gravity.z());
  sand.level_y = static_cast<float>(-spacing * gravity.y() / gravity.z());
  sand.friction = static_cast<float>(friction);
  sand.repose_rise = static_cast<float>(friction * spacing);
  sand.layer_fraction = static_cast<float>(material.layer_fraction);
  sand.layer_depth =
      static_cast<float>(std::min<double>(material.layer_depth, std::numeric_limits<float>::max()));
  sand.epsilon = static_cast<float>(std::pow(0.1 * spacing, 4));
  return sand;
}

}  // namespace shallow_sand
