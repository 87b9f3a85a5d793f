#pragma once

#include <ros/ros.h>

#include <optional>
#include <vector>

#include "shallow_sand/ros/body_handles.h"
#include "shallow_sand/ros/body_markers.h"
#include "shallow_sand/ros/body_services.h"
#include "shallow_sand/ros/height_field_publisher.h"
#include "shallow_sand/ros/loop_calls.h"
#include "shallow_sand/ros/node_parameters.h"
#include "shallow_sand/ros/particles_publisher.h"
#include "shallow_sand/ros/pour_topic.h"
#include "shallow_sand/ros/robot.h"
#include "shallow_sand/ros/sand_bodies.h"
#include "shallow_sand/ros/sand_editing.h"
#include "shallow_sand/ros/sand_queries.h"
#include "shallow_sand/ros/sand_setting.h"
#include "shallow_sand/ros/sand_states.h"
#include "shallow_sand/ros/surface_publisher.h"
#include "shallow_sand/ros/transform_reader.h"
#include "shallow_sand/sim/simulator.h"

namespace shallow_sand {

/// The node. Its contract:
/// - reads NodeParameters once; a bad one ends it with exit code 2 and one line;
/// - bodies: the scene's, links of the robots in ~robots by their tf frames, and those of ~add_body; a
/// description may come later, tf may stop: the log says what is missing and the node goes on;
/// - runs with ROS time (`use_sim_time` too), ~tf_delay behind it, so that the poses that the sand needs have
/// come; what it publishes is stamped with that earlier time. What lies more than 0.1 s back at a frame is
/// given up, and ~status says by how much the sand lags; bodies cross what was given up without speed. When
/// time goes backwards the sand goes on from there;
/// - serves ~add_body, ~move_body and ~remove_body; meshes are read and sampled beside the sand;
/// - serves ~edit_sand, ~set_sand, ~query_surface, ~volume_in_polygon, ~save and ~load, and saves snapshots
/// of itself;
/// - publishes ~points, ~mesh (latched, at ~publish_rate), ~height_field and its updates, each beside the
/// sand: the sand hands over what has changed, on the GPU while the next frame runs, and waits for nobody;
/// and ~particles while somebody listens, if the scene has grains;
/// - publishes ~status (latched, once a second) and ~bodies (latched, when one has moved, at most at
/// ~publish_rate);
/// - takes sand from and for ~pour, and lets bodies be dragged by interactive markers under ~body_handles;
/// - at the end writes ~report, ~picture and ~mesh_file.
class SandNode {
 public:
  /// @throws SceneError
  SandNode();
  /// Until ROS shuts down. @throws InvalidParameter if the scene cannot go on (a fixed step that breaks its
  /// bound)
  void run();

 private:
  /// To be called when ROS time went backwards by `duration`.
  void restart(const ros::Duration& duration);
  /// What is due at a time of the sand: bodies, sand, messages.
  void update(const ros::Time& time);
  /// Starts to bring the sand up to `time`.
  void beginAdvance(const ros::Time& time);
  void requestFields(const ros::Time& time);
  /// Gives those that were requested to those who wait for them.
  void handOverFields();
  void showBodies();
  void publishStatus(const ros::Time& time);
  void writeResults() const;

  ros::NodeHandle node_;
  ros::NodeHandle private_node_{"~"};
  NodeParameters parameters_;
  Simulator simulator_;
  TransformReader transforms_;
  SandBodies bodies_;
  std::vector<Robot> robots_;
  LoopCalls loop_calls_;
  SandStates states_;  ///< before what tells others of the sand
  BodyServices services_;
  SandEditing editing_;
  SandSetting setting_;
  SandQueries queries_;
  PourTopic pour_;
  BodyMarkers body_markers_;
  BodyHandles body_handles_;
  HeightFieldPublisher height_field_;
  SurfacePublisher surface_;
  std::optional<ParticlesPublisher> particles_;  ///< if the scene has grains
  ros::Publisher status_;
  std::optional<ros::Time> requested_;  ///< time of the fields that are under way from the simulator
  ros::Time last_now_;                  ///< ROS time; the next two are times of the sand
  ros::Time last_frame_;
  ros::Time last_status_;
  ros::WallTime last_status_wall_;
  ros::WallTime last_bodies_;  ///< when they were shown
  double last_status_simulated_ = 0.0;
  double busy_ = 0.0;  ///< time spent in the simulator [s]
};

}  // namespace shallow_sand
