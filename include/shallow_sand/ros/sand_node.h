#pragma once

#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include <functional>
#include <optional>
#include <vector>

#include "shallow_sand/Step.h"
#include "shallow_sand/ros/body_handles.h"
#include "shallow_sand/ros/body_markers.h"
#include "shallow_sand/ros/body_services.h"
#include "shallow_sand/ros/call_record.h"
#include "shallow_sand/ros/call_replay.h"
#include "shallow_sand/ros/contacts_publisher.h"
#include "shallow_sand/ros/diagnostics.h"
#include "shallow_sand/ros/frame_clock.h"
#include "shallow_sand/ros/height_field_publisher.h"
#include "shallow_sand/ros/loop_calls.h"
#include "shallow_sand/ros/node_parameters.h"
#include "shallow_sand/ros/particles_publisher.h"
#include "shallow_sand/ros/pour_topic.h"
#include "shallow_sand/ros/reconfiguration.h"
#include "shallow_sand/ros/robot.h"
#include "shallow_sand/ros/running_pour.h"
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
/// - reads NodeParameters once; a bad one ends it with exit code 2 and one line; some of them, and material
/// and gravity, can be changed later through ~reconfigure;
/// - bodies: the scene's, links of the robots in ~robots by their tf frames, and those of ~add_body; a
/// description may come later, tf may stop: the log says what is missing and the node goes on;
/// - runs with ROS time (`use_sim_time` too), ~tf_delay behind it, so that the poses that the sand needs have
/// come, in frames that begin and end at the same instants of ROS time in every run; what it publishes is
/// stamped with that earlier time. What it cannot catch up is given up, and ~status says how much; bodies
/// cross what was given up without speed. When time goes backwards the sand goes on from there;
/// - ~pause stops the sand (~paused: from the start on), ~step runs it on while it is paused, ~reset brings
/// back the sand of the start;
/// - serves ~add_body, ~move_body and ~remove_body; meshes are read and sampled beside the sand;
/// - serves ~edit_sand, ~set_sand, ~query_surface, ~volume_in_polygon, ~save and ~load, and saves snapshots
/// of itself;
/// - publishes ~points, ~mesh (latched, at ~publish_rate), ~height_field and its updates, each beside the
/// sand: the sand hands over what has changed, on the GPU while the next frame runs, and waits for nobody;
/// and, while somebody listens, ~contacts and, if the scene has grains, ~particles;
/// - publishes ~status (latched, once a second) and ~bodies (latched, when one has moved, at most at
/// ~publish_rate);
/// - publishes /diagnostics, once a second of the wall clock;
/// - publishes on ~calls what changed the sand or its bodies by service, ~pour or handle, and does it again
/// at the same frames when a bag plays it on ~replay_calls;
/// - takes sand from and for ~pour, and lets bodies be dragged by interactive markers under ~body_handles;
/// - at the end writes ~report, ~picture and ~mesh_file.
class SandNode {
 public:
  /// Answers nothing before run() is called, and only in the thread that does.
  /// @param node for names that are not private, @param private_node for its own
  /// @throws SceneError
  SandNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node);
  /// As long as `goesOn` and ROS runs. @throws InvalidParameter if the scene cannot go on (a fixed step that
  /// breaks its bound)
  void run(const std::function<bool()>& goesOn);

 private:
  /// What a turn of the loop does: it takes what has come, runs frames that are due, and tells the news.
  void turn();
  /// To be called when ROS time went backwards by `duration`.
  void restart(const ros::Duration& duration);
  /// Frames up to ROS time `now`, as many as it may take without keeping others waiting.
  void runDueFrames(const ros::Time& now);
  /// The next frame: bodies and sand, up to the time that the clock gives.
  void runFrame();
  /// Messages that are due.
  void publish();
  bool pause(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response);
  bool step(Step::Request& request, Step::Response& response);
  bool reset(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  std::string startAnew();
  /// Runs a paused sand on by whole frames. @throws InvalidParameter if it is not paused, or for a duration
  /// that is too long or none
  void stepBy(double duration);
  /// Until tf has come up to `time` for what moves, at most until `deadline`.
  void waitForPoses(const ros::Time& time, const ros::WallTime& deadline) const;
  /// ROS time less ~tf_delay: what the sand runs up to; zero before there is such a time.
  ros::Time sandTime() const;
  void requestFields();
  /// Gives those that were requested to those who wait for them.
  void handOverFields();
  /// Some of those that dynamic_reconfigure changes are others.
  void takeParameters();
  void showBodies();
  void publishStatus();
  void writeResults() const;

  ros::CallbackQueue queue_;
  ros::NodeHandle node_;
  ros::NodeHandle private_node_;
  NodeParameters parameters_;
  Simulator simulator_;
  FrameClock clock_;
  TransformReader transforms_;
  SandBodies bodies_;
  std::vector<Robot> robots_;
  LoopCalls loop_calls_;
  CallRecord calls_;
  SandStates states_;  ///< before what tells others of the sand
  BodyServices services_;
  SandEditing editing_;
  SandSetting setting_;
  SandQueries queries_;
  PourTopic pour_;
  RunningPour running_pour_;
  BodyMarkers body_markers_;
  BodyHandles body_handles_;
  HeightFieldPublisher height_field_;
  SurfacePublisher surface_;
  ContactsPublisher contacts_;
  std::optional<ParticlesPublisher> particles_;  ///< if the scene has grains
  CallReplay replay_;
  Diagnostics diagnostics_;
  Reconfiguration reconfiguration_;
  ros::Publisher status_;
  ros::ServiceServer pause_;
  ros::ServiceServer step_;
  ros::ServiceServer reset_;
  bool paused_;
  ros::WallRate rate_;                  ///< of the loop
  std::optional<ros::Time> requested_;  ///< time of the fields that are under way from the simulator
  ros::Time last_now_;                  ///< ROS time
  ros::WallTime last_status_;
  ros::WallTime last_bodies_;            ///< when they were shown
  double simulated_since_status_ = 0.0;  ///< [s]
  double told_given_up_ = 0.0;           ///< in the log [s]
  std::uint64_t steps_in_frame_ = 0;     ///< of the last one
  double busy_ = 0.0;                    ///< time spent in the simulator [s]
};

}  // namespace shallow_sand
