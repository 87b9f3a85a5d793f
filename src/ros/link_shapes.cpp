#include "shallow_sand/ros/link_shapes.h"

#include <yaml-cpp/yaml.h>

#include "shallow_sand/bodies/link_selection.h"
#include "shallow_sand/core/parameters.h"
#include "shallow_sand/scene/scene.h"

namespace shallow_sand {

LinkShapes readLinkShapes(const YAML::Node& map, const std::string& source) {
  LinkShapes shapes;
  if (!map.IsMap()) {
    throw SceneError(source + ": shapes: " + YAML::Dump(map) +
                     "; expected a map from patterns of link names to shapes, such as {bucket: convex_hull}");
  }
  for (const auto& entry : map) {
    const auto pattern = entry.first.as<std::string>();
    try {
      const std::string name = entry.second.IsScalar() ? entry.second.Scalar() : YAML::Dump(entry.second);
      shapes[pattern] = linkShapeFromString(name, "shapes." + pattern);
    } catch (const InvalidParameter& problem) {
      throw SceneError(source + ": " + problem.what());
    }
  }
  return shapes;
}

LinkShape shapeOf(const LinkShapes& shapes, const std::string& link) {
  LinkShape shape = LinkShape::exact;
  std::size_t longest = 0;
  for (const auto& [pattern, candidate] : shapes) {
    if (pattern.size() < longest || !matchesPattern(pattern, link)) continue;
    longest = pattern.size();
    shape = candidate;
  }
  return shape;
}

std::vector<std::string> unmatchedPatterns(const LinkShapes& shapes, const std::vector<std::string>& links) {
  std::vector<std::string> patterns;
  for (const auto& entry : shapes) patterns.push_back(entry.first);
  return unmatchedPatterns(patterns, links);
}

}  // namespace shallow_sand
