#pragma once

#include <cmath>

#include "shallow_sand/core/parameters.h"
#include "shallow_sand/device/window.h"
#include "shallow_sand/solver/cover.h"

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
/// All cells of any grid.
LocalRegion wholeMap();
/// Cells whose centres may be in a region.
Window windowOf(const LocalRegion& region, const Grid& grid);

/// Sand on bodies that hang over the ground's; all null where there are no bodies.
struct HangingSand {
  float* depth;  ///< [m]
  float* momentum_x;
  float* momentum_y;
  const float* elevation;  ///< of what it lies on [m]
  const float*
      ceiling;  ///< depth of the ground's sand for which there is room, infinite if no body is above [m]
  const Cover* cover;

  SHALLOW_SAND_HOST_DEVICE bool isAt(long long at) const {
    return depth != nullptr && cover[at] == Cover::hanging;
  }
};

/// Changes the depth of sand in a region, and counts what each cell really took: its float rounds every
/// addition. Sand that is taken away takes its momentum along; sand that is added has none.
struct ChangeSand {
  float* depth;
  float* momentum_x;
  float* momentum_y;
  const float* bed;
  HangingSand hanging;
  double* taken;  ///< depth by which each cell of the window has grown so far, row-major [m]
  Window window;
  int columns;
  float spacing;
  LocalRegion region;
  EditOperation operation;
  float value;  ///< [m]
  const float*
      values;  ///< one a cell instead, NaN for cells that stay as they are; null: `value` for all [m]

  /// Becomes a change by a volume [m³] that falls on an area [m²].
  SHALLOW_SAND_HOST_DEVICE void pour(double volume, double area) {
    const double depth = volume / area;
    operation = depth < 0.0 ? EditOperation::remove : EditOperation::add;
    value = static_cast<float>(depth < 0.0 ? -depth : depth);
  }

  SHALLOW_SAND_HOST_DEVICE bool covers(int i, int j) const {
    return region.holds((static_cast<float>(i) + 0.5f) * spacing, (static_cast<float>(j) + 0.5f) * spacing);
  }

  SHALLOW_SAND_HOST_DEVICE void operator()(int i, int j) const {
    if (!covers(i, j)) return;
    const long long at = static_cast<long long>(j) * columns + i;
    const float amount = values == nullptr ? value : values[at];
    if (amount != amount) return;
    double grown = 0.0;
    if (hanging.isAt(at)) {
      const float load = hanging.depth[at];
      grown =
          become(hanging.depth[at], hanging.momentum_x[at], hanging.momentum_y[at], changedLoad(at, amount));
      grown += become(depth[at], momentum_x[at], momentum_y[at], changedUnder(at, load, amount));
    } else {
      grown = become(depth[at], momentum_x[at], momentum_y[at], changed(depth[at], bed[at], amount));
    }
    taken[static_cast<long long>(j - window.row_begin) * window.columns() + (i - window.column_begin)] +=
        grown;
  }

 private:
  SHALLOW_SAND_HOST_DEVICE float changed(float h, float b, float amount) const {
    switch (operation) {
      case EditOperation::add:
        return h + amount;
      case EditOperation::remove:
        return maximum(h - amount, 0.0f);
      case EditOperation::set:
        return amount;
      default:
        return maximum(amount - b, 0.0f);
    }
  }

  /// Sand comes and goes from above: a body catches what falls, and what is taken is taken from it first.
  SHALLOW_SAND_HOST_DEVICE float changedLoad(long long at, float amount) const {
    if (operation == EditOperation::set) return maximum(amount - hanging.ceiling[at], 0.0f);
    return changed(hanging.depth[at], hanging.elevation[at], amount);
  }
  /// @param load what lay above before [m]
  SHALLOW_SAND_HOST_DEVICE float changedUnder(long long at, float load, float amount) const {
    if (operation == EditOperation::add) return depth[at];
    if (operation == EditOperation::remove) return maximum(depth[at] - maximum(amount - load, 0.0f), 0.0f);
    return minimum(changed(depth[at], bed[at], amount), hanging.ceiling[at]);
  }

  /// Gives sand a new depth. Returns by how much it grew. [m]
  SHALLOW_SAND_HOST_DEVICE static double become(float& h, float& hu, float& hv, float after) {
    const float before = h;
    if (after < before) {
      const float kept = after / before;
      // Adding 0 leaves no negative zeros, which would be bits that a step changes.
      hu = kept * hu + 0.0f;
      hv = kept * hv + 0.0f;
    }
    h = after;
    return static_cast<double>(after) - static_cast<double>(before);
  }
};

}  // namespace shallow_sand
