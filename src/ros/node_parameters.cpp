#include "shallow_sand/ros/node_parameters.h"

#include <xmlrpcpp/XmlRpcException.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <locale>
#include <sstream>
#include <type_traits>

#include "shallow_sand/core/nearest_name.h"
#include "shallow_sand/core/one_line.h"
#include "shallow_sand/ros/parameter_table.h"
#include "shallow_sand/scene/mesh_file.h"
#include "shallow_sand/scene/state_folder.h"

namespace shallow_sand {

namespace {

/// With all of its digits, and infinities as they are read: yaml-cpp 0.6 writes neither.
YAML::Node toYaml(double value) {
  if (std::isinf(value)) return YAML::Node(value > 0.0 ? ".inf" : "-.inf");
  if (std::isnan(value)) return YAML::Node(".nan");
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text.precision(std::numeric_limits<double>::max_digits10);
  text << value;
  return YAML::Node(text.str());
}

/// @throws XmlRpc::XmlRpcException for dates and binary data
YAML::Node toYaml(XmlRpc::XmlRpcValue& value) {
  switch (value.getType()) {
    case XmlRpc::XmlRpcValue::TypeBoolean:
      return YAML::Node(static_cast<bool>(value));
    case XmlRpc::XmlRpcValue::TypeInt:
      return YAML::Node(static_cast<int>(value));
    case XmlRpc::XmlRpcValue::TypeDouble:
      return toYaml(static_cast<double>(value));
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

/// The keys of a map, to which there is nothing in a scene file for dates and binary data.
YAML::Node toYaml(XmlRpc::XmlRpcValue& map, const std::string& source) {
  YAML::Node yaml(YAML::NodeType::Map);
  for (auto& [key, value] : map) {
    try {
      yaml[key] = toYaml(value);
    } catch (const XmlRpc::XmlRpcException& problem) {
      throw SceneError(source + ": " + key + ": a date or binary data (" + problem.getMessage() +
                       "); expected numbers, texts, true or false, and lists and maps of them");
    }
  }
  return yaml;
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

/// Takes what has a place in NodeParameters.
void takeRow(YAML::Node& yaml, const std::string& source, const ParameterRow& row,
             NodeParameters& parameters) {
  const auto take_to = [&](auto target) {
    if constexpr (!std::is_same_v<decltype(target), std::monostate>)
      take(yaml, source, row.name, row.expected, parameters.*target);
  };
  std::visit(take_to, row.target);
  const auto number = std::get_if<double NodeParameters::*>(&row.target);
  if (number != nullptr) row.require(parameters.**number);
}

/// Every key that is left has to be one of a scene.
void requireSceneKeys(const YAML::Node& yaml, const std::string& source) {
  const std::vector<std::string>& scene_keys = sceneKeys();
  std::vector<std::string> known = scene_keys;
  for (const ParameterRow& row : parameterTable()) known.push_back(row.name);
  for (const auto& entry : yaml) {
    const std::string key = entry.first.as<std::string>();
    if (std::find(scene_keys.begin(), scene_keys.end(), key) == scene_keys.end())
      throw SceneError(source + ": " + key + ": unknown; expected a known key, such as " +
                       nearestName(oneLine(key), known));
  }
}

/// Where ROS keeps what its nodes write.
std::string defaultStateFolder() {
  const char* home = std::getenv("ROS_HOME");
  if (home != nullptr && *home == '/') return home + std::string("/shallow_sand");
  home = std::getenv("HOME");
  return home != nullptr && *home == '/' ? home + std::string("/.ros/shallow_sand") : "/tmp/shallow_sand";
}

/// @throws InvalidParameter
void requireStateFolder(NodeParameters& parameters) {
  if (parameters.state_folder.empty()) parameters.state_folder = defaultStateFolder();
  if (parameters.state_folder.front() != '/')
    throw InvalidParameter("state_folder", parameters.state_folder, "an absolute path");
  try {
    fileWithin(parameters.state_folder, parameters.snapshot_file);
  } catch (const InvalidParameter& problem) {
    throw InvalidParameter("snapshot_file", parameters.snapshot_file, problem.expected());
  }
}

/// Which links of a robot dig, and as what.
void takeLinks(YAML::Node& parameters, const std::string& source, RobotParameters& robot) {
  take(parameters, source, "include", parameterRow("include").expected, robot.links.include);
  take(parameters, source, "exclude", parameterRow("exclude").expected, robot.links.exclude);
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
  take(robot, source, "tf_prefix", parameterRow("tf_prefix").expected, parameters.tf_prefix);
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
  take(parameters, source, "robot_description", parameterRow("robot_description").expected,
       single.description);
  take(parameters, source, "tf_prefix", parameterRow("tf_prefix").expected, single.tf_prefix);
  takeLinks(parameters, source, single);
  std::vector<YAML::Node> list;
  take(parameters, source, "robots", parameterRow("robots").expected, list);
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
  XmlRpc::XmlRpcValue all;
  private_node.getParam(private_node.getNamespace(), all);
  return readNodeParameters(all, "parameters of " + private_node.getNamespace());
}

NodeParameters readNodeParameters(XmlRpc::XmlRpcValue& all, const std::string& source) {
  YAML::Node yaml(YAML::NodeType::Map);
  if (all.getType() == XmlRpc::XmlRpcValue::TypeStruct) yaml = toYaml(all, source);
  NodeParameters parameters;
  parameters.robots = takeRobots(yaml, source);
  try {
    for (const ParameterRow& row : parameterTable()) takeRow(yaml, source, row, parameters);
    requireStateFolder(parameters);
    if (!parameters.mesh_file.empty()) requireMeshSuffix("mesh_file", parameters.mesh_file);
  } catch (const InvalidParameter& problem) {
    throw SceneError(source + ": " + problem.what());
  }
  // What the node before this one has left there.
  yaml.remove(kReconfigureNamespace);
  requireSceneKeys(yaml, source);
  parameters.scene = readScene(yaml, source, parameters.scene_folder);
  if (!parameters.sand_frame.empty()) parameters.scene.parameters.grid.frame = parameters.sand_frame;
  return parameters;
}

}  // namespace shallow_sand
