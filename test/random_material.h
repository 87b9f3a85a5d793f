#pragma once

#include "random_fields.h"

namespace shallow_sand {

/// Sand of another kind; what maps give stays.
inline Material otherMaterial(std::mt19937& random, const Simulator& simulator, const MaterialFields& maps) {
  Material material = simulator.parameters().material;
  const double spacing = simulator.grid().spacing;
  if (maps.friction_angle.empty()) material.friction_angle = uniform(random, 5.0, 60.0) * M_PI / 180.0;
  if (maps.layer_fraction.empty()) material.layer_fraction = uniform(random, 0.3, 1.0);
  if (maps.layer_depth.empty()) {
    material.layer_depth =
        random() % 3 == 0 ? std::numeric_limits<double>::infinity() : uniform(random, 1.0, 20.0) * spacing;
  }
  return material;
}

/// Gravity of any strength that leans by up to 20°. [m/s²]
inline Eigen::Vector3d otherGravity(std::mt19937& random) {
  return uniform(random, 0.2, 2.0) * randomGravity(random, 3.0);
}

}  // namespace shallow_sand
