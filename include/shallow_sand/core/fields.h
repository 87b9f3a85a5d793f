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

/// Material that varies over the map: each list is empty (then Material holds everywhere) or has one value a
/// cell, row-major, row 0 at the smallest y, within the bounds of Material's members of these names.
struct MaterialFields {
  std::vector<float> friction_angle;  ///< [rad]
  std::vector<float> layer_fraction;
  std::vector<float> layer_depth;  ///< [m]
};

}  // namespace shallow_sand
