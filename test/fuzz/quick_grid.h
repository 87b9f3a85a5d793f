#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

#include "shallow_sand/core/parameters.h"

namespace shallow_sand {

/// The number below some keys of a scene, as far as it is one.
inline double numberAt(YAML::Node node, const std::string& key, int item, double otherwise) {
  for (const std::string& name : {std::string("grid"), key}) {
    if (!node.IsMap()) {
      return otherwise;
    }
    node.reset(static_cast<const YAML::Node&>(node)[name]);
  }
  if (node.IsSequence() && item < static_cast<int>(node.size())) {
    node.reset(node[item]);
  }
  double number = otherwise;
  return node.IsScalar() && YAML::convert<double>::decode(node, number) ? number : otherwise;
}

/// Whether a scene's grid is one that is read in no time.
inline bool isQuick(const YAML::Node& root) {
  constexpr double kMostCells = 2e4;
  const GridParameters defaults;
  const double width = numberAt(root, "size", 0, defaults.size.x());
  const double height = numberAt(root, "size", 1, defaults.size.y());
  const double spacing = numberAt(root, "spacing", 0, defaults.spacing);
  return !(width * height > 1.01 * kMostCells * spacing * spacing);
}

}  // namespace shallow_sand
