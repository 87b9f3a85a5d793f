#pragma once

#include <string>
#include <vector>

namespace shallow_sand {

/// Which links of a robot touch sand: shell patterns of link names, as fnmatch(3) has them.
struct LinkPatterns {
  std::vector<std::string> include;  ///< a link must match one of these; none: all match
  std::vector<std::string> exclude;  ///< and none of these
};

/// As fnmatch(3) has it.
bool matchesPattern(const std::string& pattern, const std::string& name);

/// Those patterns that match none of the names.
std::vector<std::string> unmatchedPatterns(const std::vector<std::string>& patterns,
                                           const std::vector<std::string>& names);

struct LinkSelection {
  std::string urdf;                    ///< the description, collision elements of chosen links only
  std::vector<std::string> available;  ///< links with collision elements, in the order of the description
  std::vector<std::string> unmatched;  ///< patterns that match none of these
};

/// Takes the collision elements of links that are not chosen out of a robot's description, so that nobody
/// reads their meshes. What is no XML comes back as it was.
LinkSelection selectLinks(const std::string& urdf_xml, const LinkPatterns& patterns);

}  // namespace shallow_sand
