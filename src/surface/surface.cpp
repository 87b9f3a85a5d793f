#include "shallow_sand/surface/surface.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace shallow_sand {

namespace {

const Eigen::Vector3f kSand(0.93f, 0.78f, 0.54f);
const Eigen::Vector3f kBareBed(0.52f, 0.51f, 0.50f);

/// How much light a point gets from the north-west, 1 where the ground is level. Viewers light a mesh from
/// the camera, which hides ruts; this shows them.
float relief(const Surface& surface, const Grid& grid, int i, int j) {
  const auto elevation = [&](int column, int row) {
    return surface
        .points[grid.index(std::clamp(column, 0, grid.columns - 1), std::clamp(row, 0, grid.rows - 1))]
        .z();
  };
  const float slope_x = (elevation(i + 1, j) - elevation(i - 1, j)) / (2.0f * grid.spacing);
  const float slope_y = (elevation(i, j + 1) - elevation(i, j - 1)) / (2.0f * grid.spacing);
  const Eigen::Vector3f normal = Eigen::Vector3f(-slope_x, -slope_y, 1.0f).normalized();
  const Eigen::Vector3f light = Eigen::Vector3f(-0.5f, 0.5f, 1.0f).normalized();
  return std::clamp(normal.dot(light) / light.z(), 0.35f, 1.25f);
}

}  // namespace

Surface surfaceOf(const Grid& grid, const Fields& fields) {
  Surface surface;
  surface.points.resize(grid.cells());
  surface.colors.resize(grid.cells());
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      const std::size_t k = grid.index(i, j);
      surface.points[k] =
          Eigen::Vector3d(grid.x(i), grid.y(j), fields.surface(k)).cast<float>();
    }
  }
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      const std::size_t k = grid.index(i, j);
      const Eigen::Vector3f& material = fields.allDepth(k) < 0.1f * grid.spacing ? kBareBed : kSand;
      surface.colors[k] = (relief(surface, grid, i, j) * material).cwiseMin(1.0f);
    }
  }
  return surface;
}

std::vector<std::size_t> surfaceTriangles(const Grid& grid) {
  std::vector<std::size_t> corners;
  for (int j = 0; j + 1 < grid.rows; ++j) {
    for (int i = 0; i + 1 < grid.columns; ++i) {
      const std::size_t south_west = grid.index(i, j);
      const std::size_t south_east = grid.index(i + 1, j);
      const std::size_t north_west = grid.index(i, j + 1);
      const std::size_t north_east = grid.index(i + 1, j + 1);
      corners.insert(corners.end(), {south_west, south_east, north_east, south_west, north_east, north_west});
    }
  }
  return corners;
}

}  // namespace shallow_sand
