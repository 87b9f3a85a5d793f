#include "shallow_sand/ros/reconfiguration.h"

#include <ros/console.h>

#include <boost/make_shared.hpp>
#include <chrono>
#include <cmath>
#include <future>
#include <memory>
#include <sstream>
#include <utility>

#include "shallow_sand/ros/parameter_table.h"
#include "shallow_sand/ros/queued_call.h"
#include "shallow_sand/ros/running_pour.h"

namespace shallow_sand {
namespace {

constexpr double kDegree = M_PI / 180.0;

/// What the node before this one has left there is not what this one starts with.
ros::NodeHandle withStart(const ros::NodeHandle& node, ros::CallbackQueue& queue, const SandConfig& start) {
  ros::NodeHandle own(node, kReconfigureNamespace);
  own.setCallbackQueue(&queue);
  start.__toServer__(own);
  return own;
}

/// Numbers that were not asked to change keep their bits: an angle is not turned to degrees and back.
Material materialOf(const SandConfig& wanted, const SandConfig& taken, Material material) {
  if (wanted.friction_angle != taken.friction_angle)
    material.friction_angle = wanted.friction_angle * kDegree;
  if (wanted.layer_fraction != taken.layer_fraction) material.layer_fraction = wanted.layer_fraction;
  if (wanted.layer_depth != taken.layer_depth) material.layer_depth = wanted.layer_depth;
  return material;
}

bool operator==(const Material& a, const Material& b) {
  return a.friction_angle == b.friction_angle && a.layer_fraction == b.layer_fraction &&
         a.layer_depth == b.layer_depth;
}

/// What is another than before, for the log.
std::string changesBetween(const SandConfig& before, const SandConfig& now) {
  std::ostringstream changes;
  for (const auto& parameter : SandConfig::__getParamDescriptions__()) {
    boost::any was;
    boost::any is;
    parameter->getValue(before, was);
    parameter->getValue(now, is);
    const double from = boost::any_cast<double>(was);
    const double to = boost::any_cast<double>(is);
    if (from != to)
      changes << (changes.tellp() > 0 ? ", " : "") << parameter->name << " " << to << " (was " << from << ")";
  }
  return changes.str();
}

}  // namespace

SandConfig startingConfig(const NodeParameters& parameters, const SimulatorParameters& sand) {
  SandConfig config = SandConfig::__getDefault__();
  config.friction_angle = sand.material.friction_angle / kDegree;
  config.layer_fraction = sand.material.layer_fraction;
  config.layer_depth = sand.material.layer_depth;
  config.gravity_x = sand.gravity.x();
  config.gravity_y = sand.gravity.y();
  config.gravity_z = sand.gravity.z();
  config.publish_rate = parameters.publish_rate;
  config.height_field_rate = parameters.height_field_rate;
  config.frame_rate = parameters.frame_rate;
  config.pour_rate = parameters.pour_rate;
  config.pour_x = parameters.pour_x;
  config.pour_y = parameters.pour_y;
  config.pour_radius = parameters.pour_radius;
  config.max_body_speed = parameters.max_body_speed;
  return config;
}

Reconfiguration::Reconfiguration(const ros::NodeHandle& node, NodeParameters& parameters,
                                 Simulator& simulator, std::function<void()> changed)
    : parameters_(parameters),
      simulator_(simulator),
      changed_(std::move(changed)),
      sand_queue_(*node.getCallbackQueue()),
      taken_(startingConfig(parameters, simulator.parameters())),
      server_(mutex_, withStart(node, queue_, taken_)) {
  server_.updateConfig(taken_);
  server_.setCallback([this](SandConfig& wanted, std::uint32_t) { ask(wanted); });
  asking_ = true;
  spinner_.start();
}

Reconfiguration::~Reconfiguration() {
  asking_ = false;
  spinner_.stop();
}

void Reconfiguration::ask(SandConfig& wanted) {
  // The first call is the server's own, with what there is.
  if (!asking_) return;
  const auto answer = std::make_shared<std::promise<SandConfig>>();
  std::future<SandConfig> answered = answer->get_future();
  sand_queue_.addCallback(
      boost::make_shared<QueuedCall>([this, answer, wanted] { answer->set_value(take(wanted)); }));
  while (asking_ && answered.wait_for(std::chrono::milliseconds(50)) != std::future_status::ready) {
  }
  if (asking_) wanted = answered.get();
}

SandConfig Reconfiguration::take(const SandConfig& wanted) {
  try {
    apply(wanted);
  } catch (const InvalidParameter& problem) {
    ROS_WARN_STREAM("reconfigure: " << problem.what() << "; all stays as it was");
    return taken_;
  }
  const std::string changes = changesBetween(taken_, wanted);
  if (!changes.empty()) ROS_INFO_STREAM("reconfigured: " << changes);
  taken_ = wanted;
  return taken_;
}

void Reconfiguration::apply(const SandConfig& wanted) {
  const Eigen::Vector3d gravity(wanted.gravity_x, wanted.gravity_y, wanted.gravity_z);
  const SimulatorParameters& now = simulator_.parameters();
  const Material material = materialOf(wanted, taken_, now.material);
  // All that can be refused, before anything changes.
  validateGravity(gravity);
  for (const auto& [name, value] : {std::pair{"publish_rate", wanted.publish_rate},
                                    {"height_field_rate", wanted.height_field_rate},
                                    {"max_body_speed", wanted.max_body_speed},
                                    {"frame_rate", wanted.frame_rate},
                                    {"pour_rate", wanted.pour_rate},
                                    {"pour_x", wanted.pour_x},
                                    {"pour_y", wanted.pour_y},
                                    {"pour_radius", wanted.pour_radius}})
    parameterRow(name).require(value);
  RunningPour::require(wanted.pour_rate, {wanted.pour_x, wanted.pour_y}, wanted.pour_radius,
                       simulator_.grid());
  // Sand that is told what it is already would wake up for nothing.
  if (!(material == now.material)) simulator_.setMaterial(material);
  if (gravity != now.gravity) simulator_.setGravity(gravity);
  parameters_.publish_rate = wanted.publish_rate;
  parameters_.height_field_rate = wanted.height_field_rate;
  parameters_.max_body_speed = wanted.max_body_speed;
  parameters_.frame_rate = wanted.frame_rate;
  parameters_.pour_rate = wanted.pour_rate;
  parameters_.pour_x = wanted.pour_x;
  parameters_.pour_y = wanted.pour_y;
  parameters_.pour_radius = wanted.pour_radius;
  changed_();
}

}  // namespace shallow_sand
