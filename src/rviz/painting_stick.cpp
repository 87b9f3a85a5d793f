#include "shallow_sand/rviz/painting_stick.h"

#include <geometry_msgs/PoseStamped.h>

#include <algorithm>
#include <utility>

#include "shallow_sand/RemoveBody.h"

namespace shallow_sand {
namespace {

/// No pose is told longer before it holds. [s]
constexpr double kMostAhead = 0.5;

/// A little more than between two looks of the node at poses. [s]
constexpr double kRest = 0.025;

/// More than a node needs to subscribe to poses, once it has said that it has the stick. [s]
constexpr double kConnects = 1.0;

/// tf takes one pose of a time. [s]
constexpr double kSameTime = 1e-4;

AddBody::Request requestFor(const std::string& sand_node, const PaintingStick::Shape& shape) {
  AddBody::Request request;
  // A name that no stick had before, in this rviz or another.
  request.name = "painting_stick_" + std::to_string(ros::WallTime::now().toNSec() / 1000000);
  request.shape.type = shape_msgs::SolidPrimitive::CYLINDER;
  request.shape.dimensions = {shape.length, shape.radius};
  request.pose_topic = sand_node + "/" + request.name + "/pose";
  return request;
}

}  // namespace

PaintingStick::PaintingStick(ros::NodeHandle node, const std::string& sand_node, const std::string& frame,
                             const Shape& shape, const Ogre::Vector3& tip)
    : sand_node_(sand_node),
      body_(requestFor(sand_node, shape)),
      frame_(frame),
      tip_(tip),
      advanced_(ros::Time::now()) {
  publisher_ = node.advertise<geometry_msgs::PoseStamped>(body_.pose_topic, 100);
  body_.pose_topic = publisher_.getTopic();
  adding_ = answerLater([service = sand_node_ + "/add_body", request = body_] {
    AddBody add;
    add.request = request;
    return askNode(service, add);
  });
}

std::optional<NodeAnswer> PaintingStick::news() {
  if (!hasCome(adding_)) return std::nullopt;
  const NodeAnswer answer = adding_.get();
  if (answer.success) followed_ = ros::SteadyTime::now();
  return answer;
}

bool PaintingStick::isLost() const {
  return !followed_.isZero() && publisher_.getNumSubscribers() == 0 &&
         ros::SteadyTime::now() - followed_ > ros::WallDuration(kConnects);
}

void PaintingStick::goTo(const Ogre::Vector3& tip, double speed) {
  way_.push_back({tip, static_cast<double>(lastPlace().distance(tip)) / speed});
}

void PaintingStick::rest() { way_.push_back({lastPlace(), kRest}); }

void PaintingStick::advance(const ros::Time& now) {
  // As far ahead as rviz needs until it comes here again: what the node knows too late interrupts a stroke.
  const double ahead = std::clamp((now - advanced_).toSec(), 0.0, kMostAhead);
  advanced_ = now;
  if (publisher_.getNumSubscribers() == 0 || now.isZero()) return;
  followed_ = ros::SteadyTime::now();
  // It rested until now, or time went back.
  if (stamp_ < now || stamp_ > now + ros::Duration(kMostAhead)) publish(now);
  const ros::Time begin = stamp_;
  const ros::Time end = now + ros::Duration(ahead);
  const double duration = (end - begin).toSec();
  if (duration < kSameTime) return;
  double needed = 0.0;
  for (const Leg& leg : way_) needed += leg.duration;
  // Evenly, where there is more time than it needs.
  const double stretch = std::max(1.0, duration / std::max(needed, kSameTime));
  double left = duration / stretch;
  while (!way_.empty() && way_.front().duration <= left) {
    left -= way_.front().duration;
    tip_ = way_.front().to;
    way_.pop_front();
    const ros::Time stamp = end - ros::Duration(left * stretch);
    if ((stamp - stamp_).toSec() > kSameTime && (end - stamp).toSec() > kSameTime) publish(stamp);
  }
  if (!way_.empty()) {
    Leg& leg = way_.front();
    tip_ += (leg.to - tip_) * static_cast<float>(left / leg.duration);
    leg.duration -= left;
  }
  publish(end);
}

void PaintingStick::publish(const ros::Time& stamp) {
  geometry_msgs::PoseStamped pose;
  pose.header.frame_id = frame_;
  pose.header.stamp = stamp_ = stamp;
  pose.pose.position.x = static_cast<double>(tip_.x);
  pose.pose.position.y = static_cast<double>(tip_.y);
  pose.pose.position.z =
      static_cast<double>(tip_.z) + 0.5 * body_.shape.dimensions[shape_msgs::SolidPrimitive::CYLINDER_HEIGHT];
  pose.pose.orientation.w = 1.0;
  publisher_.publish(pose);
}

std::future<NodeAnswer> PaintingStick::remove() {
  return answerLater([adding = std::move(adding_), service = sand_node_ + "/remove_body",
                      name = body_.name]() mutable -> NodeAnswer {
    if (adding.valid()) {
      const NodeAnswer added = adding.get();
      if (!added.success) return added;
    }
    RemoveBody body;
    body.request.name = name;
    return askNode(service, body);
  });
}

}  // namespace shallow_sand
