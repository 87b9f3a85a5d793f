#include "shallow_sand/ros/body_handles.h"

#include <ros/console.h>
#include <tf2_eigen/tf2_eigen.h>

#include <algorithm>
#include <boost/make_shared.hpp>
#include <cmath>

#include "shallow_sand/MoveBody.h"
#include "shallow_sand/ros/poses.h"
#include "shallow_sand/ros/queued_call.h"

namespace shallow_sand {
namespace {

using visualization_msgs::InteractiveMarker;
using visualization_msgs::InteractiveMarkerControl;
using visualization_msgs::InteractiveMarkerFeedback;

/// Messages that are further apart are not of one drag; a body lags behind its marker by no more [s].
constexpr double kLongestPeriod = 0.1;
/// So long after the last message a marker belongs to the hand [s].
constexpr double kHold = 0.5;

InteractiveMarkerControl controlAlong(const Eigen::Vector3d& axis, int mode) {
  InteractiveMarkerControl control;
  control.interaction_mode = static_cast<std::uint8_t>(mode);
  // The x axis of a control is what it moves along, or turns about.
  control.orientation = tf2::toMsg(Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitX(), axis));
  return control;
}

InteractiveMarkerControl controlWith(const visualization_msgs::Marker& look) {
  InteractiveMarkerControl control;
  control.interaction_mode = InteractiveMarkerControl::MOVE_3D;
  control.orientation.w = 1.0;
  control.always_visible = true;
  control.markers.push_back(look);
  control.markers.back().pose.orientation.w = 1.0;
  return control;
}

}  // namespace

BodyHandles::BodyHandles(const ros::NodeHandle& node, const std::string& sand_frame, const FrameClock& clock,
                         const CallRecord& calls, const SandBodies& bodies)
    : queue_(*node.getCallbackQueue()),
      sand_frame_(sand_frame),
      clock_(clock),
      calls_(calls),
      bodies_(bodies),
      server_(node.getNamespace() + "/body_handles") {}

void BodyHandles::update(const std::vector<ShownBody>& shown) {
  std::map<std::string, Handle> gone = handles_;
  for (const ShownBody& body : shown) {
    if (!body.appearance.handle) continue;
    gone.erase(body.name);
    const auto known = handles_.find(body.name);
    if (known == handles_.end()) {
      insert(body);
      continue;
    }
    Handle& handle = known->second;
    const bool is_held = !handle.refused && !handle.dragged.isZero() &&
                         std::abs((ros::Time::now() - handle.dragged).toSec()) < kHold;
    if (is_held || (!handle.refused && handle.pose.matrix() == body.pose.matrix())) continue;
    server_.setPose(body.name, tf2::toMsg(body.pose));
    handle.pose = body.pose;
    handle.refused = false;
  }
  for (const auto& handle : gone) {
    server_.erase(handle.first);
    handles_.erase(handle.first);
  }
  server_.applyChanges();
}

void BodyHandles::insert(const ShownBody& body) {
  InteractiveMarker marker;
  marker.header.frame_id = sand_frame_;
  marker.name = marker.description = body.name;
  marker.pose = tf2::toMsg(body.pose);
  marker.scale = static_cast<float>(1.5 * body.size);
  marker.controls.push_back(controlWith(body.appearance.look));
  for (int axis = 0; axis < 3; ++axis) {
    for (const int mode : {InteractiveMarkerControl::MOVE_AXIS, InteractiveMarkerControl::ROTATE_AXIS})
      marker.controls.push_back(controlAlong(Eigen::Vector3d::Unit(axis), mode));
  }
  for (std::size_t k = 0; k < marker.controls.size(); ++k) marker.controls[k].name = std::to_string(k);
  server_.insert(marker,
                 [this](const interactive_markers::InteractiveMarkerServer::FeedbackConstPtr& feedback) {
                   // The server takes its messages from the global queue, in whatever thread.
                   queue_.addCallback(boost::make_shared<QueuedCall>([this, feedback] { take(*feedback); }));
                 });
  handles_[body.name] = Handle{body.pose, {}, false};
}

void BodyHandles::take(const InteractiveMarkerFeedback& feedback) {
  const auto handle = handles_.find(feedback.marker_name);
  if (feedback.event_type != InteractiveMarkerFeedback::POSE_UPDATE || handle == handles_.end()) return;
  try {
    drag(feedback, handle->second);
  } catch (const std::exception& problem) {
    handle->second.refused = true;
    ROS_WARN_STREAM_THROTTLE(5.0, "~body_handles/feedback: body "
                                      << feedback.marker_name
                                      << " cannot be dragged there: " << problem.what());
  }
}

void BodyHandles::drag(const InteractiveMarkerFeedback& feedback, Handle& handle) {
  const Eigen::Isometry3d pose = bodies_.poseOf(feedback.header.frame_id) * rigid(feedback.pose);
  const ros::Time now = ros::Time::now();
  const double since = handle.dragged.isZero() ? kLongestPeriod : (now - handle.dragged).toSec();
  // Time may have gone back.
  const double period = std::clamp(since, std::min(clock_.length(), kLongestPeriod), kLongestPeriod);
  // Just as long would be too fast by a rounding.
  const double least = 1.001 * bodies_.leastDuration(feedback.marker_name, pose);
  MoveBody::Request move;
  move.name = feedback.marker_name;
  move.pose.pose = tf2::toMsg(pose);
  move.duration = std::max(period, least);
  calls_.make("move_body", move);
  handle.dragged = now;
}

}  // namespace shallow_sand
