#include "shallow_sand/ros/robot_bodies.h"

#include <ros/console.h>
#include <tf2_eigen/tf2_eigen.h>

#include "shallow_sand/bodies/body_geometry.h"

namespace shallow_sand {

RobotBodies::RobotBodies(const std::string& urdf, const NodeParameters& parameters, Simulator& simulator)
    : sand_frame_(parameters.scene.parameters.grid.frame), timeout_(parameters.tf_timeout) {
  const RobotGeometry robot = collisionGeometry(urdf);
  for (const std::string& problem : robot.problems) ROS_ERROR_STREAM(problem);
  std::size_t done = 0;
  for (const LinkGeometry& geometry : robot.links) {
    ROS_INFO_STREAM("robot " << robot.robot << ": distance field of link " << geometry.link << " (" << ++done
                             << " of " << robot.links.size() << ")");
    try {
      addLink(geometry, parameters.tf_prefix, simulator);
    } catch (const InvalidParameter& problem) {
      ROS_ERROR_STREAM("robot " << robot.robot << ", link " << geometry.link
                                << " is left out: " << problem.what());
    }
  }
  if (links_.empty()) {
    ROS_ERROR_STREAM("robot " << robot.robot
                              << " has no link with collision geometry that can be read; it leaves no "
                              << "trace in the sand");
  }
}

void RobotBodies::addLink(const LinkGeometry& geometry, const std::string& tf_prefix, Simulator& simulator) {
  const double spacing = distanceSpacing(geometry.mesh, simulator.grid().spacing);
  auto field = std::make_shared<const DistanceField>(computeDistanceField(geometry.mesh, spacing));
  Link link;
  link.name = geometry.link;
  link.frame = tf_prefix + geometry.link;
  link.body = simulator.addBody(geometry.link, std::move(field));
  link.status.name = geometry.link;
  link.status.state = BodyStatus::WAITING;
  links_.push_back(link);
}

void RobotBodies::restartClock() {
  since_ = ros::Time();
  for (Link& link : links_) link.stamp = ros::Time();
}

void RobotBodies::update(const tf2_ros::Buffer& buffer, const ros::Time& now, double simulated_time,
                         Simulator& simulator) {
  if (since_.isZero()) since_ = now;
  for (Link& link : links_) updateLink(link, buffer, now, simulated_time, simulator);
}

void RobotBodies::updateLink(Link& link, const tf2_ros::Buffer& buffer, const ros::Time& now,
                             double simulated_time, Simulator& simulator) {
  try {
    const geometry_msgs::TransformStamped transform =
        buffer.lookupTransform(sand_frame_, link.frame, ros::Time(0));
    // A stamp of zero: nothing but static transforms, which hold for ever.
    const bool timed = !transform.header.stamp.isZero();
    const ros::Duration age = now - transform.header.stamp;
    if (timed && age > timeout_) {
      report(link, BodyStatus::STALE, "its newest pose is " + std::to_string(age.toSec()) + " s old");
      return;
    }
    simulator.appendPose(link.body, simulated_time, tf2::transformToEigen(transform.transform));
    link.stamp = timed ? transform.header.stamp : now;
    report(link, BodyStatus::MOVING, "");
  } catch (const tf2::TransformException& problem) {
    // Right after the start tf has not come yet; that is no news.
    if (link.stamp.isZero() && now - since_ < timeout_) return;
    report(link, link.stamp.isZero() ? BodyStatus::WAITING : BodyStatus::STALE, problem.what());
  } catch (const InvalidParameter& problem) {
    report(link, link.stamp.isZero() ? BodyStatus::WAITING : BodyStatus::STALE, problem.what());
  }
}

void RobotBodies::report(Link& link, std::uint8_t state, const std::string& problem) const {
  const bool news = state != link.status.state || (link.status.problem.empty() != problem.empty());
  link.status.state = state;
  link.status.problem = problem;
  if (!news) return;
  if (problem.empty()) {
    ROS_INFO_STREAM("link " << link.name << " is in the sand's frame " << sand_frame_);
  } else {
    ROS_ERROR_STREAM("link " << link.name << ": no pose from tf frame " << link.frame
                             << " in the sand's frame " << sand_frame_ << ": " << problem << "; "
                             << (state == BodyStatus::WAITING ? "it stays out of the sand until one comes"
                                                              : "it rests where it was last seen"));
  }
}

std::vector<BodyStatus> RobotBodies::status() const {
  std::vector<BodyStatus> all;
  for (const Link& link : links_) all.push_back(link.status);
  return all;
}

}  // namespace shallow_sand
