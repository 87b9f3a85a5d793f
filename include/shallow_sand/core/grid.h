#pragma once

#include <cstddef>

#include "shallow_sand/core/types.h"

namespace shallow_sand {

/// A uniform grid of square cells in the plane z = 0 of its frame (paper: I, spacing ΔL).
/// Cell (i, j) is column i along x and row j along y; fields are row-major, row 0 at the smallest y.
struct Grid {
  int columns = 0;
  int rows = 0;
  float spacing = 0.0f;   ///< ΔL [m]
  double origin_x = 0.0;  ///< corner of cell (0, 0) with the smallest x [m]
  double origin_y = 0.0;  ///< corner of cell (0, 0) with the smallest y [m]

  std::size_t cells() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
  std::size_t index(int i, int j) const {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(i);
  }
  /// Centre of a cell [m].
  double x(int i) const { return origin_x + (i + 0.5) * static_cast<double>(spacing); }
  double y(int j) const { return origin_y + (j + 0.5) * static_cast<double>(spacing); }
  double cellArea() const { return static_cast<double>(spacing) * static_cast<double>(spacing); }  ///< [m²]
};

}  // namespace shallow_sand
