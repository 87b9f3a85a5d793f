#pragma once

#include <cstddef>
#include <vector>

namespace shallow_sand {

/// Depth of sand along a line; x rises.
struct Profile {
  std::vector<double> x;      ///< [m]
  std::vector<double> depth;  ///< [m]

  /// Depth at a place, linear between samples; that of the nearest sample beyond the first, nothing beyond
  /// the last. [m]
  double at(double place) const {
    if (place <= x.front()) return depth.front();
    for (std::size_t k = 1; k < x.size(); ++k) {
      if (place > x[k]) continue;
      const double part = (place - x[k - 1]) / (x[k] - x[k - 1]);
      return (1.0 - part) * depth[k - 1] + part * depth[k];
    }
    return 0.0;
  }

  /// The greatest x at which the sand is `threshold` deep, linear between samples; the first x if it nowhere
  /// is. [m]
  double reach(double threshold) const {
    for (std::size_t k = x.size(); k-- > 1;) {
      if (depth[k - 1] < threshold) continue;
      const double part = (depth[k - 1] - threshold) / (depth[k - 1] - depth[k]);
      return depth[k] >= threshold ? x[k] : x[k - 1] + part * (x[k] - x[k - 1]);
    }
    return x.front();
  }
};

}  // namespace shallow_sand
