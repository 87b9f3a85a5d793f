#include "shallow_sand/ros/node_parameters.h"

#include <yaml-cpp/yaml.h>

#include <cmath>

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

void takePositive(YAML::Node& parameters, const std::string& source, const std::string& key,
                  const std::string& expected, double& value) {
  take(parameters, source, key, expected, value);
  if (value > 0.0 && std::isfinite(value)) return;
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
  const std::string text = "a text";
  take(yaml, source, "robot_description", "the name of a parameter", parameters.robot_description);
  take(yaml, source, "tf_prefix", text, parameters.tf_prefix);
  take(yaml, source, "report", "the path of a file", parameters.report);
  take(yaml, source, "picture", "the path of a file", parameters.picture);
  takePositive(yaml, source, "frame_rate", "a positive number of hertz", parameters.frame_rate);
  takePositive(yaml, source, "publish_rate", "a positive number of hertz", parameters.publish_rate);
  takePositive(yaml, source, "tf_timeout", "a positive number of seconds", parameters.tf_timeout);
  std::string sand_frame;
  take(yaml, source, "sand_frame", "the name of a tf frame", sand_frame);
  parameters.scene = readScene(yaml, source);
  if (!sand_frame.empty()) parameters.scene.parameters.grid.frame = sand_frame;
  return parameters;
}

}  // namespace shallow_sand
