#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "shallow_sand/core/grid.h"

namespace shallow_sand {

/// The state of the sand, on the host; one float a cell, row-major, row 0 at the smallest y. Bed, depth and
/// momentum are those of the ground.
struct Fields {
  std::vector<float> bed;         ///< elevation b [m]
  std::vector<float> depth;       ///< h [m]
  std::vector<float> momentum_x;  ///< hu [m²/s]
  std::vector<float> momentum_y;  ///< hv [m²/s]

  /// Sand that lies on bodies; these are empty as long as there are none.
  std::vector<float> load{};             ///< its depth [m]
  std::vector<float> load_elevation{};   ///< what it lies on; 0 where there is no body [m]
  std::vector<float> load_momentum_x{};  ///< [m²/s]
  std::vector<float> load_momentum_y{};

  /// There are loads from now on, of no sand.
  void addLoads() {
    for (std::vector<float>* values : {&load, &load_elevation, &load_momentum_x, &load_momentum_y})
      values->assign(depth.size(), 0.0f);
  }

  /// Where the sand that one sees from above ends. [m]
  float surface(std::size_t cell) const {
    return hasLoad(cell) ? load_elevation[cell] + load[cell] : bed[cell] + depth[cell];
  }
  /// Depth of all sand of a cell. [m]
  float allDepth(std::size_t cell) const { return load.empty() ? depth[cell] : depth[cell] + load[cell]; }
  static constexpr float kDust = 0.001f;  ///< sand of a load that one does not see [m]
  /// Whether so much lies on a body that one sees it: grains that hang on to a link are no surface of sand.
  bool hasLoad(std::size_t cell) const { return !load.empty() && load[cell] >= kDust; }
};

/// Numbers for some cells of a map; one a cell, laid out as in Fields.
struct CellValues {
  std::vector<float> values;        ///< anything where none is given
  std::vector<std::uint8_t> given;  ///< 0: there is no number for this cell
};

/// Sand thinner than a tenth of a cell counts as bare bed (sections 6.3 and 7.2). [m]
inline float bareDepth(const Grid& grid) { return 0.1f * grid.spacing; }

/// How high what one sees may rise from one cell to the next, in cells. What is steeper is no slope of sand
/// but the rim of a load.
constexpr float kSteepest = 3.0f;

/// Material that varies over the map: each list is empty (then Material holds everywhere) or has one value a
/// cell, row-major, row 0 at the smallest y, within the bounds of Material's members of these names.
struct MaterialFields {
  std::vector<float> friction_angle;  ///< [rad]
  std::vector<float> layer_fraction;
  std::vector<float> layer_depth;  ///< [m]
};

}  // namespace shallow_sand
