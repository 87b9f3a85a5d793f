#pragma once

#include <vector>

namespace shallow_sand {

/// The state of the sand, on the host; one float a cell, row-major, row 0 at the smallest y.
struct Fields {
  std::vector<float> bed;         ///< elevation b [m]
  std::vector<float> depth;       ///< h [m]
  std::vector<float> momentum_x;  ///< hu [m²/s]
  std::vector<float> momentum_y;  ///< hv [m²/s]
};

}  // namespace shallow_sand
