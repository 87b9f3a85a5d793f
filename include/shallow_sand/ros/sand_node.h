#pragma once

#include <ros/ros.h>
#include <tf2_ros/transform_listener.h>

#include <optional>

#include "shallow_sand/ros/node_parameters.h"
#include "shallow_sand/ros/robot_bodies.h"
#include "shallow_sand/sim/simulator.h"

namespace shallow_sand {

/// The node. Its contract:
/// - reads NodeParameters once; a bad one ends it with exit code 2 and one line;
/// - bodies: links of the URDF in the parameter named ~robot_description, by their tf frames; the description
///   may come later, tf may stop: the log says what is missing and the node goes on;
/// - runs with ROS time (`use_sim_time` too). What lies more than 0.1 s back at a frame is given up, and
/// ~status
///   says by how much the sand lags; when time goes backwards it goes on from there;
/// - publishes ~points, ~mesh (latched, at ~publish_rate) and ~status (latched, once a second);
/// - at the end writes ~report and ~picture.
class SandNode {
 public:
  /// @throws SceneError
  SandNode();
  /// Until ROS shuts down. @throws InvalidParameter if the scene cannot go on (a fixed step that breaks its
  /// bound)
  void run();

 private:
  void findRobot(const ros::Time& now);
  /// Tells what keeps the robot away, once.
  void describe(const std::string& problem);
  /// Brings the sand up to `now`.
  void advance(const ros::Time& now);
  void publishSurface(const ros::Time& now);
  void publishStatus(const ros::Time& now);
  void writeResults() const;

  ros::NodeHandle node_;
  ros::NodeHandle private_node_{"~"};
  NodeParameters parameters_;
  Simulator simulator_;
  tf2_ros::Buffer buffer_;
  tf2_ros::TransformListener listener_{buffer_};
  std::optional<RobotBodies> robot_;
  ros::Publisher points_;
  ros::Publisher mesh_;
  ros::Publisher status_;
  ros::Time last_frame_;
  ros::Time last_surface_;
  ros::Time last_status_;
  ros::Time last_search_;
  ros::WallTime last_status_wall_;
  double last_status_simulated_ = 0.0;
  double busy_ = 0.0;                ///< time spent in the simulator [s]
  std::string described_problem_;    ///< told last
  std::string refused_description_;  ///< no URDF; not to be tried again
};

}  // namespace shallow_sand
