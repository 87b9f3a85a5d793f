#include "shallow_sand/ros/transform_reader.h"

#include <ros/console.h>
#include <ros/message_event.h>

#include <cmath>
#include <sstream>

#include "shallow_sand/core/one_line.h"

namespace shallow_sand {
namespace {

using Event = ros::MessageEvent<tf2_msgs::TFMessage const>;

/// After ROS time went back, transforms from the time before arrive for this long. [s of wall time]
constexpr double kRestart = 1.0;

/// A frame that is refused again and again is told of no more often. [s]
constexpr double kTellAgain = 60.0;

std::string withoutSlash(const std::string& frame) {
  return !frame.empty() && frame.front() == '/' ? frame.substr(1) : frame;
}

/// What is wrong with a transform, in words; empty if nothing is. The bound on a rotation's norm is tf2's.
std::string problemOf(const geometry_msgs::TransformStamped& stamped) {
  const auto& t = stamped.transform.translation;
  const auto& q = stamped.transform.rotation;
  std::ostringstream problem;
  const double squared = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
  if (!std::isfinite(t.x) || !std::isfinite(t.y) || !std::isfinite(t.z)) {
    problem << "translation (" << t.x << ", " << t.y << ", " << t.z << "); expected finite numbers";
  } else if (!(std::abs(squared - 1.0) < 0.01)) {
    problem << "rotation (" << q.x << ", " << q.y << ", " << q.z << ", " << q.w
            << "); expected a quaternion of length 1";
  } else if (withoutSlash(stamped.header.frame_id).empty()) {
    problem << "its parent has no name; expected a tf frame";
  } else if (withoutSlash(stamped.header.frame_id) == withoutSlash(stamped.child_frame_id)) {
    problem << "it is its own parent; expected another tf frame";
  }
  return problem.str();
}

}  // namespace

TransformReader::TransformReader() {
  node_.setCallbackQueue(&queue_);
  const auto subscribe = [this](const char* topic, bool is_static) {
    const boost::function<void(const Event&)> callback = [this, is_static](const Event& event) {
      read(*event.getConstMessage(), event.getPublisherName(), is_static);
    };
    return node_.subscribe<tf2_msgs::TFMessage const>(topic, 100, callback, ros::VoidConstPtr(),
                                                      ros::TransportHints().tcpNoDelay());
  };
  tf_ = subscribe("/tf", false);
  tf_static_ = subscribe("/tf_static", true);
  spinner_.start();
}

void TransformReader::take(const geometry_msgs::TransformStamped& transform) {
  tf2_msgs::TFMessage message;
  message.transforms.push_back(transform);
  read(message, "a pose", false);
}

void TransformReader::restart() {
  const std::lock_guard<std::mutex> lock(mutex_);
  buffer_.clear();
  last_read_ = ros::Time();
  restarted_ = ros::WallTime::now();
}

void TransformReader::read(const tf2_msgs::TFMessage& message, const std::string& authority, bool is_static) {
  const ros::Time now = ros::Time::now();
  if (now < last_read_) restart();
  const std::lock_guard<std::mutex> lock(mutex_);
  last_read_ = now;
  const bool restarting = (ros::WallTime::now() - restarted_).toSec() < kRestart;
  for (const geometry_msgs::TransformStamped& transform : message.transforms) {
    if (restarting && !is_static && transform.header.stamp > now + ros::Duration(1.0)) continue;
    const std::string frame = withoutSlash(transform.child_frame_id);
    if (const std::string problem = problemOf(transform); !problem.empty()) {
      refuse(frame, "from " + authority + ": " + problem);
      continue;
    }
    if (const auto refusal = refusals_.find(frame); refusal != refusals_.end()) refusal->second.holds = false;
    buffer_.setTransform(transform, authority, is_static);
  }
}

void TransformReader::refuse(const std::string& frame, const std::string& problem) {
  Refusal& refusal = refusals_[frame];
  refusal.problem = problem;
  refusal.holds = true;
  const ros::WallTime now = ros::WallTime::now();
  if (!refusal.told.isZero() && (now - refusal.told).toSec() < kTellAgain) return;
  refusal.told = now;
  ROS_ERROR_STREAM("tf frame " << oneLine(frame)
                               << ": a transform is refused, the one before stays: " << problem);
}

std::string TransformReader::refusal(const std::string& frame) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::string ancestor = withoutSlash(frame);
  // As deep as tf2 goes: a loop of frames has no end.
  for (int depth = 0; depth < 1000; ++depth) {
    const auto refusal = refusals_.find(ancestor);
    if (refusal != refusals_.end() && refusal->second.holds) {
      return "tf frame " + ancestor + " " + refusal->second.problem;
    }
    if (!buffer_._getParent(ancestor, ros::Time(), ancestor)) break;
  }
  return "";
}

}  // namespace shallow_sand
