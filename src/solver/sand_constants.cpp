#include "shallow_sand/solver/sand_constants.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace shallow_sand {

LocalMaterial localMaterial(const Material& material, const Grid& grid) {
  const double deepest = std::numeric_limits<float>::max();
  return {static_cast<float>(std::tan(material.friction_angle) * static_cast<double>(grid.spacing)),
          static_cast<float>(material.layer_fraction),
          static_cast<float>(std::min(material.layer_depth, deepest))};
}

LocalMaterialFields localMaterial(const Material& material, const MaterialFields& fields, const Grid& grid) {
  LocalMaterialFields result;
  if (fields.friction_angle.empty() && fields.layer_fraction.empty() && fields.layer_depth.empty())
    return result;
  Material local = material;
  for (std::size_t k = 0; k < grid.cells(); ++k) {
    if (!fields.friction_angle.empty()) local.friction_angle = fields.friction_angle[k];
    if (!fields.layer_fraction.empty()) local.layer_fraction = fields.layer_fraction[k];
    if (!fields.layer_depth.empty()) local.layer_depth = fields.layer_depth[k];
    const LocalMaterial rounded = localMaterial(local, grid);
    result.repose_rise.push_back(rounded.repose_rise);
    result.layer_fraction.push_back(rounded.layer_fraction);
    result.layer_depth.push_back(rounded.layer_depth);
  }
  return result;
}

SandConstants sandConstants(const Grid& grid, const Eigen::Vector3d& gravity, const Material& material) {
  const double spacing = grid.spacing;
  SandConstants sand;
  sand.spacing = grid.spacing;
  sand.gravity = static_cast<float>(-gravity.z());
  sand.gravity_per_spacing = static_cast<float>(-gravity.z() / spacing);
  sand.gravity_x = static_cast<float>(gravity.x());
  sand.gravity_y = static_cast<float>(gravity.y());
  sand.level_x = static_cast<float>(-spacing * gravity.x() / gravity.z());
  sand.level_y = static_cast<float>(-spacing * gravity.y() / gravity.z());
  sand.epsilon = static_cast<float>(std::pow(0.02 * spacing, 4));
  sand.film = static_cast<float>(0.01 * spacing);
  sand.uniform = localMaterial(material, grid);
  return sand;
}

}  // namespace shallow_sand
