#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <ros/node_handle.h>

#include <map>
#include <string>

#include "shallow_sand/ros/transform_reader.h"

namespace shallow_sand {

/// geometry_msgs/PoseStamped for bodies that tf does not know: each message becomes a transform of a frame
/// that only this node has, so that the body follows it as others follow tf. A message without a frame is in
/// the sand's, one without a stamp is of now.
class PoseTopics {
 public:
  /// @param node from whose callback queue messages are taken; its name begins the frames
  /// @param transforms must outlive this
  PoseTopics(const ros::NodeHandle& node, const std::string& sand_frame, TransformReader& transforms);

  /// Returns the frame that a body has to follow. @throws InvalidParameter if it is no name of a topic
  std::string follow(const std::string& body, const std::string& topic);
  /// No more messages for a body, if it had any.
  void forget(const std::string& body) { subscribers_.erase(body); }

 private:
  ros::NodeHandle node_;
  std::string sand_frame_;
  TransformReader& transforms_;
  std::map<std::string, ros::Subscriber> subscribers_;  ///< by body
};

}  // namespace shallow_sand
