#include "shallow_sand/ros/robot.h"

#include <ros/console.h>

namespace shallow_sand {

Robot::Robot(const RobotParameters& parameters, bool alone, double sand_spacing)
    : parameters_(parameters), alone_(alone), sand_spacing_(sand_spacing) {}

void Robot::update(const ros::NodeHandle& node, SandBodies& bodies) {
  if (!loader_) findDescription(node);
  if (!loader_) return;
  try {
    for (const LinkLoader::Link& link : loader_->takeReady()) addLink(link, bodies);
  } catch (const InvalidParameter& problem) {
    loader_.reset();
    describe("parameter " + node.resolveName(parameters_.description) + ": " + problem.what());
  }
}

void Robot::findDescription(const ros::NodeHandle& node) {
  const ros::WallTime now = ros::WallTime::now();
  if (!last_search_.isZero() && (now - last_search_).toSec() < 1.0) return;
  last_search_ = now;
  std::string urdf;
  const std::string name = node.resolveName(parameters_.description);
  if (!node.getParam(name, urdf)) {
    describe("parameter " + name +
             " is not set; expected the URDF of a robot, as robot_state_publisher has it");
    return;
  }
  if (urdf == urdf_) return;
  urdf_ = urdf;
  loader_ = std::make_unique<LinkLoader>(urdf, parameters_.links, parameters_.shapes, sand_spacing_);
}

void Robot::addLink(const LinkLoader::Link& link, SandBodies& bodies) const {
  std::string robot = parameters_.name;
  if (robot.empty()) robot = parameters_.tf_prefix.substr(0, parameters_.tf_prefix.find_last_not_of('/') + 1);
  if (robot.empty()) robot = link.robot;
  const std::string full_name = robot + "/" + link.name;
  std::string name = alone_ ? link.name : full_name;
  for (int number = 1; bodies.has(name); ++number) {
    name = number == 1 ? full_name : full_name + "_" + std::to_string(number);
  }
  bodies.addFollowing(name, robot, {parameters_.tf_prefix + link.name}, link.field);
}

void Robot::describe(const std::string& problem) {
  if (problem != described_problem_) ROS_ERROR_STREAM(problem << "; no robot digs until it is there");
  described_problem_ = problem;
}

}  // namespace shallow_sand
