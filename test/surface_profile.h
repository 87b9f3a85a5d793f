#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <vector>

#include "shallow_sand/sim/simulator.h"

namespace shallow_sand {

/// Elevation of the sand's surface, interpolated between the centres of four cells. [m]
inline double surfaceAt(const Grid& grid, const Fields& fields, const Eigen::Vector2d& position) {
  const double x = (position.x() - grid.x(0)) / grid.spacing;
  const double y = (position.y() - grid.y(0)) / grid.spacing;
  const int i = std::clamp(static_cast<int>(std::floor(x)), 0, grid.columns - 2);
  const int j = std::clamp(static_cast<int>(std::floor(y)), 0, grid.rows - 2);
  const auto surface = [&](int column, int row) {
    return static_cast<double>(fields.surface(grid.index(column, row)));
  };
  const double s = x - i;
  const double t = y - j;
  return (1.0 - t) * ((1.0 - s) * surface(i, j) + s * surface(i + 1, j)) +
         t * ((1.0 - s) * surface(i, j + 1) + s * surface(i + 1, j + 1));
}

/// Angle at which a heap of sand falls away from its top towards `heading` (a unit vector): of the line that
/// fits best where the surface is between 25 % and 75 % of the heap's height above `base`. [rad]
inline double flankAngle(const Grid& grid, const Fields& fields, const Eigen::Vector2d& top,
                         const Eigen::Vector2d& heading, double base) {
  const double height = surfaceAt(grid, fields, top) - base;
  const double stride = 0.25 * grid.spacing;
  double count = 0.0, sum_r = 0.0, sum_z = 0.0, sum_rr = 0.0, sum_rz = 0.0;
  for (double r = 0.0; r < grid.spacing * (grid.columns + grid.rows); r += stride) {
    const double z = surfaceAt(grid, fields, top + r * heading) - base;
    if (z > 0.75 * height) continue;
    if (z < 0.25 * height) break;
    count += 1.0;
    sum_r += r;
    sum_z += z;
    sum_rr += r * r;
    sum_rz += r * z;
  }
  EXPECT_GT(count, 2.0) << "too few samples for a slope";
  return std::atan(-(count * sum_rz - sum_r * sum_z) / (count * sum_rr - sum_r * sum_r));
}

}  // namespace shallow_sand
