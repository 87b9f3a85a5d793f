#pragma once

#include <string>
#include <vector>

namespace shallow_sand {

/// The one of `known` that needs the fewest letters put in, taken out or replaced to become `name`; the first
/// of several. @param known at least one
std::string nearestName(const std::string& name, const std::vector<std::string>& known);

}  // namespace shallow_sand
