#pragma once

#include <Eigen/Geometry>
#include <string>

#include "shallow_sand/ros/sand_bodies.h"

namespace shallow_sand {

/// SandBodies::poseOf. @throws InvalidParameter with this key if the frame has no name, or no pose
Eigen::Isometry3d poseOfNamedFrame(const SandBodies& bodies, const std::string& key,
                                   const std::string& frame);

}  // namespace shallow_sand
