#include "shallow_sand/ros/pose_topics.h"

#include <ros/names.h>

#include "shallow_sand/core/parameters.h"

namespace shallow_sand {
namespace {

geometry_msgs::TransformStamped transformOf(const geometry_msgs::PoseStamped& pose, const std::string& frame,
                                            const std::string& sand_frame) {
  geometry_msgs::TransformStamped transform;
  transform.header = pose.header;
  if (transform.header.frame_id.empty()) transform.header.frame_id = sand_frame;
  if (transform.header.stamp.isZero()) transform.header.stamp = ros::Time::now();
  transform.child_frame_id = frame;
  transform.transform.translation.x = pose.pose.position.x;
  transform.transform.translation.y = pose.pose.position.y;
  transform.transform.translation.z = pose.pose.position.z;
  transform.transform.rotation = pose.pose.orientation;
  return transform;
}

}  // namespace

PoseTopics::PoseTopics(const ros::NodeHandle& node, const std::string& sand_frame,
                       TransformReader& transforms)
    : node_(node), sand_frame_(sand_frame), transforms_(transforms) {}

std::string PoseTopics::follow(const std::string& body, const std::string& topic) {
  std::string problem;
  if (!ros::names::validate(topic, problem))
    throw InvalidParameter("pose_topic", topic + " (" + problem + ")", "the name of a topic");
  const std::string frame = node_.getNamespace().substr(1) + "/" + body;
  subscribers_[body] = node_.subscribe<geometry_msgs::PoseStamped>(
      topic, 100, [this, frame](const geometry_msgs::PoseStamped::ConstPtr& pose) {
        transforms_.take(transformOf(*pose, frame, sand_frame_));
      });
  return frame;
}

}  // namespace shallow_sand
