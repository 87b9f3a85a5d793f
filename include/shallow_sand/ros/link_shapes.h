#pragma once

#include <map>
#include <string>
#include <vector>

#include "shallow_sand/bodies/body_geometry.h"

namespace YAML {
class Node;
}

namespace shallow_sand {

/// What stands for links in the sand, by shell patterns of their names; ROS parameters keep no order.
using LinkShapes = std::map<std::string, LinkShape>;

/// @param source that errors name. @throws SceneError unless it is a map from patterns to shapes
LinkShapes readLinkShapes(const YAML::Node& map, const std::string& source);

/// What the longest pattern that matches the link says; `exact` if none matches.
LinkShape shapeOf(const LinkShapes& shapes, const std::string& link);

/// Patterns that match none of the links.
std::vector<std::string> unmatchedPatterns(const LinkShapes& shapes, const std::vector<std::string>& links);

}  // namespace shallow_sand
