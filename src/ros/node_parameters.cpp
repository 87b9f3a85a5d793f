#include "shallow_sand/ros/node_parameters.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cstdlib>
#include <sstream>

#include "shallow_sand/ros/conversions.h"
#include "shallow_sand/scene/mesh_file.h"
#include "shallow_sand/scene/state_folder.h"

namespace shallow_sand {

namespace {

YAML::Node toYaml(XmlRpc::XmlRpcValue& value) {
  switch (value.getType()) {
    case XmlRpc::XmlRpcValue::TypeBoolean:
      return YAML::Node(static_cast<bool>(value));
    case XmlRpc::XmlRpcValue::TypeInt:
      return YAML::Node(static_cast<int>(value));
    case XmlRpc::XmlRpcValue::TypeDouble:
      return YAML::Node(static_cast<double>(value));
    case XmlRpc::XmlRpcValue::TypeArray: {
      YAML::Node sequence(YAML::NodeType::Sequence);
      for (int k = 0; k < value.size(); ++k) sequence.push_back(toYaml(value[k]));
      return sequence;
    }
    case XmlRpc::XmlRpcValue::TypeStruct: {
      YAML::Node map(YAML::NodeType::Map);
      for (auto& entry : value) map[entry.first] = toYaml(entry.second);
      return map;
    }
    default:
      return YAML::Node(static_cast<std::string>(value));
  }
}

/// Takes a key out of the node's parameters, so that what stays are the keys of a scene.
template <class T>
void take(YAML::Node& parameters, const std::string& source, const std::string& key,
          const std::string& expected, T& value) {
  if (!parameters[key]) return;
  try {
    value = parameters[key].as<T>();
  } catch (const YAML::Exception&) {
    throw SceneError(source + ": " + key + ": " + YAML::Dump(parameters[key]) + "; expected " + expected);
  }
  parameters.remove(key);
}

/// The bounds keep periods within what ros::Duration can hold.
void takeBetween(YAML::Node& parameters, const std::string& source, const std::string& key, double low,
                 double high, const std::string& unit, double& value) {
  std::ostringstream expected_text;
  expected_text << "a number of " << unit << " from " << low << " to " << high;
  const std::string expected = expected_text.str();
  take(parameters, source, key, expected, value);
  if (value >= low && value <= high) return;
  throw SceneError(source + ": " + key + ": " + std::to_string(value) + "; expected " + expected);
}

void takeMeshFile(YAML::Node& parameters, const std::string& source, std::string& path) {
  const std::string key = "mesh_file";
  take(parameters, source, key, "the path of a file", path);
  try {
    if (!path.empty()) requireMeshSuffix(key, path);
  } catch (const InvalidParameter& problem) {
    throw SceneError(source + ": " + problem.what());
  }
}

/// Where ROS keeps what its nodes write.
std::string defaultStateFolder() {
  const char* home = std::getenv("ROS_HOME");
  if (home != nullptr && *home == '/') return home + std::string("/shallow_sand");
  home = std::getenv("HOME");
  return home != nullptr && *home == '/' ? home + std::string("/.ros/shallow_sand") : "/tmp/shallow_sand";
}

void takeSnapshots(YAML::Node& yaml, const std::string& source, NodeParameters& parameters) {
  parameters.state_folder = defaultStateFolder();
  take(yaml, source, "state_folder", "the path of a folder", parameters.state_folder);
  if (parameters.state_folder.empty() || parameters.state_folder.front() != '/')
    throw SceneError(source + ": state_folder: " + parameters.state_folder + "; expected an absolute path");
  takeBetween(yaml, source, "snapshot_period", 0.0, 1e9, "seconds", parameters.snapshot_period);
  take(yaml, source, "snapshot_file", "the name of a file", parameters.snapshot_file);
  try {
    fileWithin(parameters.state_folder, parameters.snapshot_file);
  } catch (const InvalidParameter& problem) {
    throw SceneError(source + ": snapshot_" + problem.what());
  }
  take(yaml, source, "restore", "true or false", parameters.restore);
}

/// Which links of a robot dig, and as what.
void takeLinks(YAML::Node& parameters, const std::string& source, RobotParameters& robot) {
  const std::string expected = "a list of patterns of link names, such as ['wheel_*']";
  take(parameters, source, "include", expected, robot.links.include);
  take(parameters, source, "exclude", expected, robot.links.exclude);
  if (!parameters["shapes"]) return;
  robot.shapes = readLinkShapes(parameters["shapes"], source);
  parameters.remove("shapes");
}

RobotParameters readRobot(YAML::Node robot, const std::string& source) {
  if (!robot.IsMap()) {
    throw SceneError(source + ": " + YAML::Dump(robot) + "; expected a map with the key description");
  }
  if (!robot["description"]) {
    throw SceneError(source + ": description: missing; expected the name of a parameter with a URDF");
  }
  RobotParameters parameters;
  take(robot, source, "description", "the name of a parameter", parameters.description);
  take(robot, source, "name", "a text", parameters.name);
  take(robot, source, "tf_prefix", "a text", parameters.tf_prefix);
  takeLinks(robot, source, parameters);
  for (const auto& unknown : robot) {
    throw SceneError(source + ": " + unknown.first.as<std::string>() +
                     ": unknown; expected one of description, name, tf_prefix, include, exclude, shapes");
  }
  return parameters;
}

std::vector<RobotParameters> readRobots(const YAML::Node& list, const std::string& source) {
  std::vector<RobotParameters> robots;
  for (std::size_t k = 0; k < list.size(); ++k) {
    const std::string about = source + ": robots[" + std::to_string(k) + "]";
    robots.push_back(readRobot(list[k], about));
    const std::string& name = robots.back().name;
    const bool taken = std::any_of(robots.begin(), robots.end() - 1,
                                   [&name](const RobotParameters& other) { return other.name == name; });
    if (taken && !name.empty()) {
      throw SceneError(about + ": name: " + name + "; expected a name that no other robot has");
    }
  }
  return robots;
}

/// The robots of ~robots, or the one that the parameters beside it describe.
std::vector<RobotParameters> takeRobots(YAML::Node& parameters, const std::string& source) {
  RobotParameters single;
  take(parameters, source, "robot_description", "the name of a parameter", single.description);
  take(parameters, source, "tf_prefix", "a text", single.tf_prefix);
  takeLinks(parameters, source, single);
  std::vector<YAML::Node> list;
  take(parameters, source, "robots", "a list of maps", list);
  if (list.empty() && single.description.empty()) return {};
  if (list.empty()) return {single};
  if (!single.tf_prefix.empty() || !single.links.include.empty() || !single.links.exclude.empty() ||
      !single.shapes.empty()) {
    throw SceneError(
        source +
        ": robots: given beside tf_prefix, include, exclude or shapes; expected these within robots");
  }
  return readRobots(YAML::Node(list), source);
}

}  // namespace

NodeParameters readNodeParameters(const ros::NodeHandle& private_node) {
  const std::string source = "parameters of " + private_node.getNamespace();
  YAML::Node yaml(YAML::NodeType::Map);
  XmlRpc::XmlRpcValue all;
  if (private_node.getParam(private_node.getNamespace(), all) &&
      all.getType() == XmlRpc::XmlRpcValue::TypeStruct) {
    yaml = toYaml(all);
  }
  NodeParameters parameters;
  parameters.robots = takeRobots(yaml, source);
  take(yaml, source, "report", "the path of a file", parameters.report);
  take(yaml, source, "picture", "the path of a file", parameters.picture);
  takeMeshFile(yaml, source, parameters.mesh_file);
  takeSnapshots(yaml, source, parameters);
  takeBetween(yaml, source, "frame_rate", 0.01, 1e4, "hertz", parameters.frame_rate);
  takeBetween(yaml, source, "publish_rate", 0.01, 1e4, "hertz", parameters.publish_rate);
  takeBetween(yaml, source, "height_field_rate", 0.01, 1e4, "hertz", parameters.height_field_rate);
  take(yaml, source, "publish_speed", "true or false", parameters.publish_speed);
  takeBetween(yaml, source, "mesh_cells", 100.0, kMostMarkerCells, "cells", parameters.mesh_cells);
  // tf keeps ten seconds.
  takeBetween(yaml, source, "tf_delay", 0.0, 5.0, "seconds", parameters.tf_delay);
  takeBetween(yaml, source, "tf_timeout", 0.001, 1e6, "seconds", parameters.tf_timeout);
  takeBetween(yaml, source, "max_body_speed", 1e-3, 1e6, "metres a second", parameters.max_body_speed);
  std::string sand_frame;
  take(yaml, source, "sand_frame", "the name of a tf frame", sand_frame);
  std::string scene_folder;
  take(yaml, source, "scene_folder", "the path of a folder", scene_folder);
  parameters.scene = readScene(yaml, source, scene_folder);
  if (!sand_frame.empty()) parameters.scene.parameters.grid.frame = sand_frame;
  return parameters;
}

}  // namespace shallow_sand
