#include "shallow_sand/core/nearest_name.h"

#include <algorithm>
#include <numeric>

namespace shallow_sand {

std::size_t editDistance(const std::string& from, const std::string& to) {
  std::vector<std::size_t> before(to.size() + 1);
  std::iota(before.begin(), before.end(), std::size_t{0});
  for (std::size_t i = 0; i < from.size(); ++i) {
    std::vector<std::size_t> now{i + 1};
    for (std::size_t j = 0; j < to.size(); ++j) {
      const std::size_t replaced = before[j] + (from[i] == to[j] ? 0 : 1);
      now.push_back(std::min({replaced, before[j + 1] + 1, now[j] + 1}));
    }
    before = now;
  }
  return before.back();
}

std::string nearestName(const std::string& name, const std::vector<std::string>& known) {
  return *std::min_element(known.begin(), known.end(), [&](const std::string& a, const std::string& b) {
    return editDistance(name, a) < editDistance(name, b);
  });
}

}  // namespace shallow_sand
