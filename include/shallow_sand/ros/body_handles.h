#pragma once

#include <interactive_markers/interactive_marker_server.h>

#include <map>
#include <string>
#include <vector>

#include "shallow_sand/ros/call_record.h"
#include "shallow_sand/ros/sand_bodies.h"

namespace shallow_sand {

/// Interactive markers by which bodies are dragged: under ~body_handles, one for each body that was added
/// with a handle. A body follows its marker within the time between two of the marker's messages, so that it
/// pushes sand at the speed of the hand, or at ~max_body_speed if the hand is faster.
class BodyHandles {
 public:
  /// @param node below which the topics lie; what comes is handled from its callback queue
  /// @param calls that know ~move_body, of bodies. They and the clock must outlive this
  BodyHandles(const ros::NodeHandle& node, const std::string& sand_frame, const FrameClock& clock,
              const CallRecord& calls, const SandBodies& bodies);
  /// Brings markers to the bodies, save those that are being dragged.
  void update(const std::vector<ShownBody>& shown);

 private:
  struct Handle {
    Eigen::Isometry3d pose;  ///< as it was told last
    ros::Time dragged;       ///< when the last message came
    bool refused = false;    ///< that message: the marker has to go back
  };
  void insert(const ShownBody& body);
  void take(const visualization_msgs::InteractiveMarkerFeedback& feedback);
  void drag(const visualization_msgs::InteractiveMarkerFeedback& feedback, Handle& handle);

  ros::CallbackQueueInterface& queue_;
  std::string sand_frame_;
  const FrameClock& clock_;
  const CallRecord& calls_;
  const SandBodies& bodies_;
  interactive_markers::InteractiveMarkerServer server_;
  std::map<std::string, Handle> handles_;
};

}  // namespace shallow_sand
