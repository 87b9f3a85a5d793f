#pragma once

#include <Eigen/Core>
#include <vector>

#include "shallow_sand/core/fields.h"
#include "shallow_sand/core/grid.h"

namespace shallow_sand {

/// The surface of the ground, s = h + b, one point at the centre of each cell; laid out as in Fields.
struct Surface {
  std::vector<Eigen::Vector3f> points;  ///< in the grid's frame [m]
  std::vector<Eigen::Vector3f>
      colors;  ///< red, green, blue from 0 to 1: sand shaded by its relief, bare bed grey
};

/// Sand thinner than a tenth of a cell counts as bare bed (section 7.2).
Surface surfaceOf(const Grid& grid, const Fields& fields);

/// Corners of the surface's triangles as indices of points, three for each, counter-clockwise seen from
/// above; two triangles between any four cells. Empty for a grid of one row or column.
std::vector<std::size_t> surfaceTriangles(const Grid& grid);

}  // namespace shallow_sand
