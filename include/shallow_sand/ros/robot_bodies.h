#pragma once

#include <ros/time.h>
#include <tf2_ros/buffer.h>

#include <string>
#include <vector>

#include "shallow_sand/BodyStatus.h"
#include "shallow_sand/bodies/robot_links.h"
#include "shallow_sand/ros/node_parameters.h"
#include "shallow_sand/sim/simulator.h"

namespace shallow_sand {

/// A robot's links as bodies of a simulator: geometry from its URDF, poses from tf. A link whose pose cannot
/// be had rests where it was last seen, or stays out of the sand; the log tells of every change once.
class RobotBodies {
 public:
  /// Computes the distance fields of all links with collision geometry; seconds, with progress in the log.
  /// @throws InvalidParameter if `urdf` is no URDF
  RobotBodies(const std::string& urdf, const NodeParameters& parameters, Simulator& simulator);

  /// Takes the newest poses for `simulated_time` [s].
  void update(const tf2_ros::Buffer& buffer, const ros::Time& now, double simulated_time,
              Simulator& simulator);

  /// To be called when ROS time went backwards: what is known of the age of poses no longer holds.
  void restartClock();

  std::vector<BodyStatus> status() const;

 private:
  struct Link {
    std::string name;
    std::string frame;
    std::size_t body;
    ros::Time stamp;  ///< of its newest pose; zero: none yet
    BodyStatus status;
  };
  void addLink(const LinkGeometry& geometry, const std::string& tf_prefix, Simulator& simulator);
  void updateLink(Link& link, const tf2_ros::Buffer& buffer, const ros::Time& now, double simulated_time,
                  Simulator& simulator);
  void report(Link& link, std::uint8_t state, const std::string& problem) const;

  std::string sand_frame_;
  ros::Duration timeout_;
  ros::Time since_;  ///< of the first update
  std::vector<Link> links_;
};

}  // namespace shallow_sand
