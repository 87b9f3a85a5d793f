#pragma once

#include <geometry_msgs/Pose.h>

#include <Eigen/Geometry>

namespace shallow_sand {

/// An orientation of zeros stands for none. @throws InvalidParameter if it is no pose
Eigen::Isometry3d rigid(const geometry_msgs::Pose& pose);

}  // namespace shallow_sand
