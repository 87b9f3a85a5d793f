#pragma once

#include <Eigen/Geometry>
#include <deque>

namespace shallow_sand {

/// Velocity of a rigid body: that of its frame's origin, and its angular velocity, both in the grid's frame.
struct Twist {
  Eigen::Vector3d linear{0, 0, 0};   ///< [m/s]
  Eigen::Vector3d angular{0, 0, 0};  ///< [rad/s]
};

/// Whether a pose is no farther than 1e9 m along any axis: of places, floats have to hold squares.
bool isWithinReach(const Eigen::Isometry3d& pose);

/// With which a body goes `way` [m] and makes a turn, both in `duration` [s].
Twist twistOf(const Eigen::Vector3d& way, const Eigen::AngleAxisd& turn, double duration);

/// Timed poses of a body in the grid's frame; between two of them the origin moves on a straight line and the
/// body turns about one axis, both at constant rate. Before the first and after the last pose the body rests.
class Motion {
 public:
  /// @throws InvalidParameter if the pose is not finite or not within reach, its rotation not orthonormal
  /// within 1e-3, or `time` not after the last one
  void append(double time, const Eigen::Isometry3d& pose);
  /// Drops what no query at or after `time` needs.
  void forgetBefore(double time);
  bool empty() const { return keys_.empty(); }
  /// @throws std::logic_error when there is no pose
  Eigen::Isometry3d poseAt(double time) const;
  /// With which the body came to where it is at `time`: of the segment that ends at or after `time`. A node
  /// that learns poses one by one never knows a later segment.
  Twist twistAt(double time) const;

 private:
  struct Key {
    double time;
    Eigen::Vector3d position;
    Eigen::Quaterniond rotation;
  };
  /// Index of the segment (key, next key] that holds `time`; negative outside of all.
  int segmentAt(double time) const;
  std::deque<Key> keys_;
};

}  // namespace shallow_sand
