#include "shallow_sand/ros/link_shapes.h"

#include <fnmatch.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>

#include "shallow_sand/core/parameters.h"
#include "shallow_sand/scene/scene.h"

namespace shallow_sand {
namespace {

bool matches(const std::string& pattern, const std::string& name) {
  return fnmatch(pattern.c_str(), name.c_str(), 0) == 0;
}

}  // namespace

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
    if (pattern.size() < longest || !matches(pattern, link)) continue;
    longest = pattern.size();
    shape = candidate;
  }
  return shape;
}

std::vector<std::string> unmatchedPatterns(const LinkShapes& shapes, const std::vector<std::string>& links) {
  std::vector<std::string> unmatched;
  for (const auto& entry : shapes) {
    const bool used = std::any_of(links.begin(), links.end(),
                                  [&](const std::string& link) { return matches(entry.first, link); });
    if (!used) unmatched.push_back(entry.first);
  }
  return unmatched;
}

}  // namespace shallow_sand
