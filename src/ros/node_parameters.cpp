#include "shallow_sand/ros/node_parameters.h"

#include <yaml-cpp/yaml.h>

#include <sstream>

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
  take(yaml, source, "robot_description", "the name of a parameter", parameters.robot_description);
  take(yaml, source, "tf_prefix", "a text", parameters.tf_prefix);
  take(yaml, source, "report", "the path of a file", parameters.report);
  take(yaml, source, "picture", "the path of a file", parameters.picture);
  takeBetween(yaml, source, "frame_rate", 0.01, 1e4, "hertz", parameters.frame_rate);
  takeBetween(yaml, source, "publish_rate", 0.01, 1e4, "hertz", parameters.publish_rate);
  takeBetween(yaml, source, "tf_timeout", 0.001, 1e6, "seconds", parameters.tf_timeout);
  std::string sand_frame;
  take(yaml, source, "sand_frame", "the name of a tf frame", sand_frame);
  std::string scene_folder;
  take(yaml, source, "scene_folder", "the path of a folder", scene_folder);
  parameters.scene = readScene(yaml, source, scene_folder);
  if (!sand_frame.empty()) parameters.scene.parameters.grid.frame = sand_frame;
  return parameters;
}

}  // namespace shallow_sand
