#pragma once

#include "shallow_sand/device/window.h"

namespace shallow_sand {

/// Lets sand fall on the cells of a disc, and counts what each cell really took: its float rounds every
/// addition.
struct PourSand {
  float* depth;
  double* poured;  ///< depth taken so far, one for each cell of the window, row-major [m]
  Window window;
  int columns;
  float spacing;
  float center_x;  ///< relative to the corner of cell (0, 0) [m]
  float center_y;
  float radius;  ///< [m]
  float amount;  ///< depth to add [m]

  SHALLOW_SAND_HOST_DEVICE bool covers(int i, int j) const {
    const float x = (static_cast<float>(i) + 0.5f) * spacing - center_x;
    const float y = (static_cast<float>(j) + 0.5f) * spacing - center_y;
    return x * x + y * y <= radius * radius;
  }

  SHALLOW_SAND_HOST_DEVICE void operator()(int i, int j) const {
    if (!covers(i, j)) return;
    const long long at = static_cast<long long>(j) * columns + i;
    const float before = depth[at];
    const float after = before + amount;
    depth[at] = after;
    poured[static_cast<long long>(j - window.row_begin) * window.columns() + (i - window.column_begin)] +=
        static_cast<double>(after) - static_cast<double>(before);
  }
};

}  // namespace shallow_sand
