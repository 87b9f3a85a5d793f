#pragma once

#include <cmath>

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

/// Changes the depth of sand in a region, and counts what each cell really took: its float rounds every
/// addition. Sand that is taken away takes its momentum along; sand that is added has none.
struct ChangeSand {
  float* depth;
  float* momentum_x;
  float* momentum_y;
  const float* bed;
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
    const float before = depth[at];
    const float after = changed(before, bed[at]);
    if (after < before) {
      const float kept = after / before;
      // Adding 0 leaves no negative zeros, which would be bits that a step changes.
      momentum_x[at] = kept * momentum_x[at] + 0.0f;
      momentum_y[at] = kept * momentum_y[at] + 0.0f;
    }
    depth[at] = after;
    taken[static_cast<long long>(j - window.row_begin) * window.columns() + (i - window.column_begin)] +=
        static_cast<double>(after) - static_cast<double>(before);
  }
};

}  // namespace shallow_sand
