#include "shallow_sand/ros/poses.h"

#include <cmath>
#include <sstream>

#include "shallow_sand/core/parameters.h"

namespace shallow_sand {

Eigen::Isometry3d rigid(const geometry_msgs::Pose& pose) {
  const Eigen::Vector3d position(pose.position.x, pose.position.y, pose.position.z);
  const auto& q = pose.orientation;
  Eigen::Quaterniond rotation(q.w, q.x, q.y, q.z);
  if (rotation.coeffs().isZero(0.0)) rotation.setIdentity();
  if (!position.allFinite()) {
    std::ostringstream found;
    found << position.transpose();
    throw InvalidParameter("pose.position", found.str(), "finite numbers");
  }
  // As close to 1 as tf2 wants it.
  if (!(std::abs(rotation.squaredNorm() - 1.0) < 0.01)) {
    std::ostringstream found;
    found << rotation.coeffs().transpose();
    throw InvalidParameter("pose.orientation", found.str(), "a quaternion of length 1");
  }
  return Eigen::Translation3d(position) * rotation.normalized();
}

}  // namespace shallow_sand
