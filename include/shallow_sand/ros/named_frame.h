#pragma once

#include <Eigen/Geometry>
#include <string>

#include "shallow_sand/ros/sand_bodies.h"

namespace shallow_sand {

/// Where tf has a frame now, in the sand's. @throws InvalidParameter with this key if it has no name, or no
/// pose
Eigen::Isometry3d poseOfNamedFrame(const SandBodies& bodies, const std::string& key,
                                   const std::string& frame);

}  // namespace shallow_sand
