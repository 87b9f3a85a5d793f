#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "shallow_sand/core/fields.h"
#include "shallow_sand/core/grid.h"

namespace shallow_sand {

/// Of points, the mean height of those in each cell: in the grid's frame [m]. A point on the line between two
/// cells is in that of the larger coordinate; points beside the map do not count.
class MeanHeights {
 public:
  explicit MeanHeights(const Grid& grid) : grid_(grid), sums_(grid.cells()), counts_(grid.cells()) {}
  /// @param point finite
  void add(const Eigen::Vector3d& point);
  CellValues values() const;

 private:
  Grid grid_;
  std::vector<double> sums_;
  std::vector<std::uint32_t> counts_;
};

/// Of triangles, the height of the highest over the middle of each cell, in the grid's frame [m]. A middle
/// that is a millionth of a cell beside a triangle is still over it; triangles that stand upright have none.
class HighestTriangles {
 public:
  explicit HighestTriangles(const Grid& grid);
  /// Corners in either direction, finite. @throws InvalidParameter with key `triangles` when all so far cover
  /// the map more than 16 times, and 2^24 cells more: that would take ever longer
  void add(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c);
  const CellValues& values() const { return values_; }

 private:
  void raise(std::size_t cell, double height);
  void requireFewLayers() const;

  Grid grid_;
  CellValues values_;
  std::uint64_t covered_ = 0;  ///< cells, and rows that were looked at
};

/// @throws InvalidParameter with key `height` for one above a million metres, or no number: of waves on
/// deeper sand no step is short enough
void requireBounded(const CellValues& heights, const Grid& grid);

}  // namespace shallow_sand
