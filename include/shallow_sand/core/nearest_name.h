#pragma once

#include <string>
#include <vector>

namespace shallow_sand {

/// How many letters have to be put in, taken out or replaced: Levenshtein's distance.
std::size_t editDistance(const std::string& from, const std::string& to);

/// The one of `known` that needs the fewest changes to become `name`; the first of several. @param known at
/// least one
std::string nearestName(const std::string& name, const std::vector<std::string>& known);

}  // namespace shallow_sand
