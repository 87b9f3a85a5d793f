#pragma once

#include <xmlrpcpp/XmlRpcValue.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <ctime>
#include <optional>
#include <stdexcept>
#include <string>

#include "fuzz/outcome.h"
#include "fuzz/quick_grid.h"
#include "shallow_sand/ros/node_parameters.h"
#include "shallow_sand/ros/parameter_table.h"
#include "shallow_sand/scene/state_folder.h"

namespace shallow_sand {

/// What rosparam makes of YAML.
class ServedParameters {
 public:
  /// @throws std::length_error for too many: aliases may hold themselves
  explicit ServedParameters(const YAML::Node& root) : value_(served(root, 0)) {}
  XmlRpc::XmlRpcValue& value() { return value_; }

 private:
  XmlRpc::XmlRpcValue served(const YAML::Node& node, int depth) {
    if (++count_ > 2000 || depth > 50) throw std::length_error("too many values");
    XmlRpc::XmlRpcValue value;
    if (node.IsSequence()) {
      value.setSize(static_cast<int>(node.size()));
      for (int k = 0; k < value.size(); ++k) value[k] = served(node[k], depth + 1);
    } else if (node.IsMap()) {
      value.begin();  // makes it a map, though it may stay empty
      for (const auto& entry : node) {
        if (entry.first.IsScalar()) value[entry.first.Scalar()] = served(entry.second, depth + 1);
      }
    } else {
      value = servedScalar(node);
    }
    return value;
  }

  static XmlRpc::XmlRpcValue servedScalar(const YAML::Node& node) {
    std::string text = node.IsScalar() ? node.Scalar() : "";
    int whole = 0;
    double number = 0.0;
    bool choice = false;
    if (node.Tag() == "tag:yaml.org,2002:timestamp") {
      std::tm date{};
      return XmlRpc::XmlRpcValue(&date);
    }
    if (node.Tag() == "tag:yaml.org,2002:binary") {
      return XmlRpc::XmlRpcValue(&text[0], static_cast<int>(text.size()));
    }
    if (node.Tag() == "!" || !node.IsScalar()) return XmlRpc::XmlRpcValue(text);
    if (YAML::convert<int>::decode(node, whole)) return XmlRpc::XmlRpcValue(whole);
    if (YAML::convert<double>::decode(node, number)) return XmlRpc::XmlRpcValue(number);
    if (YAML::convert<bool>::decode(node, choice)) return XmlRpc::XmlRpcValue(choice);
    return XmlRpc::XmlRpcValue(text);
  }

  int count_ = 0;
  XmlRpc::XmlRpcValue value_;
};

inline void requireLaws(const NodeParameters& parameters) {
  for (const ParameterRow& row : parameterTable()) {
    const auto target = std::get_if<double NodeParameters::*>(&row.target);
    if (target == nullptr) continue;
    const double value = parameters.**target;
    require(value >= row.low && value <= row.high, "numbers lie within the bounds of the table");
  }
  const Scene& scene = parameters.scene;
  scene.parameters.validate();
  const std::size_t cells = scene.parameters.grid.grid().cells();
  require(scene.bed.size() == cells && scene.depth.size() == cells, "each cell has a bed and a depth");
  for (std::size_t k = 0; k < cells; ++k) {
    require(std::isfinite(scene.bed[k]) && std::isfinite(scene.depth[k]) && scene.depth[k] >= 0.0f,
            "beds and depths are finite, and no depth is negative");
  }
  require(parameters.state_folder.front() == '/', "the folder of states is absolute");
  fileWithin(parameters.state_folder, parameters.snapshot_file);
  if (!parameters.sand_frame.empty())
    require(scene.parameters.grid.frame == parameters.sand_frame, "sand_frame stands for grid.frame");
  for (std::size_t k = 0; k < parameters.robots.size(); ++k) {
    for (std::size_t other = 0; other < k; ++other) {
      const std::string& name = parameters.robots[k].name;
      require(name.empty() || name != parameters.robots[other].name, "robots have names of their own");
    }
  }
}

/// The parameters that a file for rosparam makes of bytes; none if it is no such file, or a large one.
inline std::optional<ServedParameters> served(const std::uint8_t* data, std::size_t size) {
  try {
    const YAML::Node root = YAML::Load(std::string(reinterpret_cast<const char*>(data), size));
    if (isQuick(root)) return ServedParameters(root);
  } catch (const YAML::Exception&) {
  } catch (const std::length_error&) {
  }
  return std::nullopt;
}

/// Reads bytes as the node's private parameters.
inline std::string feedParameters(const std::uint8_t* data, std::size_t size) {
  auto parameters = served(data, size);
  if (!parameters) return "";
  return outcomeOf<SceneError>(
      [&] { requireLaws(readNodeParameters(parameters->value(), "parameters of /sand")); });
}

}  // namespace shallow_sand
