#pragma once

#include <cmath>
#include <cstdint>

#include "shallow_sand/core/parameters.h"
#include "shallow_sand/device/window.h"

namespace shallow_sand {

/// A region relative to the corner of cell (0, 0). It is never too small to hold the centre of a cell.
struct LocalRegion {
  float center_x;  ///< [m]
  float center_y;
  float radius;  ///< of a disc [m]; negative for a rectangle
  float half_x;  ///< of a rectangle [m]
  float half_y;

  SHALLOW_SAND_HOST_DEVICE bool holds(float x, float y) const {
    const float dx = x - center_x;
    const float dy = y - center_y;
    return radius >= 0.0f ? dx * dx + dy * dy <= radius * radius : fabsf(dx) <= half_x && fabsf(dy) <= half_y;
  }
};

LocalRegion localRegion(const Region& region, const Grid& grid);
/// Cells whose centres may be in a region.
Window windowOf(const LocalRegion& region, const Grid& grid);

/// Where sand that falls does not reach the ground, for bodies hang above it. All null where there are none.
struct Awnings {
  float* depth;                ///< of the sand on them [m]
  const float* ceiling;        ///< of the ground's sand, infinite without a body above [m]
  const std::uint8_t* closed;  ///< whether the body touches the ground's sand, which is then that on the body

  SHALLOW_SAND_HOST_DEVICE bool covers(long long at) const {
    return depth != nullptr && closed[at] == 0 && ceiling[at] < 1e30f;
  }
};

/// Changes the depth of sand in a region, and counts what each cell really took: its float rounds every
/// addition. Sand that is taken away takes its momentum along; sand that is added has none.
struct ChangeSand {
  float* depth;
  float* momentum_x;
  float* momentum_y;
  const float* bed;
  Awnings awnings;
  double* taken;  ///< depth by which each cell of the window has grown so far, row-major [m]
  Window window;
  int columns;
  float spacing;
  LocalRegion region;
  EditOperation operation;
  float value;  ///< [m]

  SHALLOW_SAND_HOST_DEVICE bool covers(int i, int j) const {
    return region.holds((static_cast<float>(i) + 0.5f) * spacing, (static_cast<float>(j) + 0.5f) * spacing);
  }

  SHALLOW_SAND_HOST_DEVICE float changed(float h, float b) const {
    switch (operation) {
      case EditOperation::add:
        return h + value;
      case EditOperation::remove:
        return maximum(h - value, 0.0f);
      case EditOperation::set:
        return value;
      default:
        return maximum(value - b, 0.0f);
    }
  }

  SHALLOW_SAND_HOST_DEVICE void operator()(int i, int j) const {
    if (!covers(i, j)) return;
    const long long at = static_cast<long long>(j) * columns + i;
    float& h = operation == EditOperation::add && awnings.covers(at) ? awnings.depth[at] : depth[at];
    const float before = h;
    const float after = changed(before, bed[at]);
    if (after < before) {
      const float kept = after / before;
      // Adding 0 leaves no negative zeros, which would be bits that a step changes.
      momentum_x[at] = kept * momentum_x[at] + 0.0f;
      momentum_y[at] = kept * momentum_y[at] + 0.0f;
    }
    h = after;
    taken[static_cast<long long>(j - window.row_begin) * window.columns() + (i - window.column_begin)] +=
        static_cast<double>(after) - static_cast<double>(before);
  }
};

}  // namespace shallow_sand
