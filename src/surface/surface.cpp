#include "shallow_sand/surface/surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

namespace shallow_sand {

namespace {

const Eigen::Vector3f kSand(0.93f, 0.78f, 0.54f);
const Eigen::Vector3f kBareBed(0.52f, 0.51f, 0.50f);

/// How high a surface may rise from one cell to the next, in cells. What is steeper is no slope of sand.
constexpr float kSteepest = 3.0f;

/// How much light a point gets from the north-west, 1 where the ground is level. Viewers light a mesh from
/// the camera, which hides ruts; this shows them.
float relief(const Surface& surface, const Grid& grid, int i, int j) {
  const float own = surface.points[grid.index(i, j)].z();
  const auto elevation = [&](int column, int row) {
    const float other =
        surface.points[grid.index(std::clamp(column, 0, grid.columns - 1), std::clamp(row, 0, grid.rows - 1))]
            .z();
    return std::abs(other - own) > kSteepest * grid.spacing ? own : other;
  };
  const float slope_x = (elevation(i + 1, j) - elevation(i - 1, j)) / (2.0f * grid.spacing);
  const float slope_y = (elevation(i, j + 1) - elevation(i, j - 1)) / (2.0f * grid.spacing);
  const Eigen::Vector3f normal = Eigen::Vector3f(-slope_x, -slope_y, 1.0f).normalized();
  const Eigen::Vector3f light = Eigen::Vector3f(-0.5f, 0.5f, 1.0f).normalized();
  return std::clamp(normal.dot(light) / light.z(), 0.35f, 1.25f);
}

/// From the elevation and the depth of the sand in each cell.
template <class Elevation, class Depth>
Surface shaded(const Grid& grid, const Elevation& elevation, const Depth& depth) {
  Surface surface;
  surface.points.resize(grid.cells());
  surface.colors.resize(grid.cells());
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      const std::size_t k = grid.index(i, j);
      surface.points[k] = Eigen::Vector3d(grid.x(i), grid.y(j), elevation(k)).cast<float>();
    }
  }
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      const std::size_t k = grid.index(i, j);
      const Eigen::Vector3f& material = depth(k) < 0.1f * grid.spacing ? kBareBed : kSand;
      surface.colors[k] = (relief(surface, grid, i, j) * material).cwiseMin(1.0f);
    }
  }
  return surface;
}

}  // namespace

Surface groundSurface(const Grid& grid, const Fields& fields) {
  return shaded(
      grid, [&](std::size_t k) { return fields.bed[k] + fields.depth[k]; },
      [&](std::size_t k) { return fields.depth[k]; });
}

Surface visibleSurface(const Grid& grid, const Fields& fields) {
  return shaded(
      grid, [&](std::size_t k) { return fields.surface(k); },
      [&](std::size_t k) { return fields.allDepth(k); });
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

std::vector<std::size_t> loadTriangles(const Grid& grid, const Fields& fields) {
  std::vector<std::size_t> corners;
  if (fields.load.empty()) return corners;
  const std::vector<std::size_t> all = surfaceTriangles(grid);
  for (std::size_t k = 0; k < all.size(); k += 3) {
    const std::array<std::size_t, 3> triangle{all[k], all[k + 1], all[k + 2]};
    const bool loaded = std::any_of(triangle.begin(), triangle.end(),
                                    [&](std::size_t corner) { return fields.hasLoad(corner); });
    if (!loaded) continue;
    const auto [low, high] =
        std::minmax({fields.surface(all[k]), fields.surface(all[k + 1]), fields.surface(all[k + 2])});
    if (high - low > kSteepest * grid.spacing) continue;
    corners.insert(corners.end(), triangle.begin(), triangle.end());
  }
  return corners;
}

}  // namespace shallow_sand
