#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "random_fields.h"
#include "random_seed.h"
#include "shallow_sand/core/parameters.h"
#include "shallow_sand/surface/cell_heights.h"
#include "shallow_sand/surface/surface_mesh.h"

namespace shallow_sand {
namespace {

/// z by x and y.
struct Plane {
  double slope_x;
  double slope_y;
  double at(double x, double y) const { return slope_x * x + slope_y * y; }
  Eigen::Vector3d point(double x, double y) const { return {x, y, at(x, y)}; }
};

Plane randomPlane(std::mt19937& random) { return {uniform(random, -2.0, 2.0), uniform(random, -2.0, 2.0)}; }

TEST(MeanHeights, OfPointsEvenlyAboutTheMiddlesAreThePlane) {
  std::mt19937 random = seededGenerator();
  for (int scene = 0; scene < 50; ++scene) {
    const Grid grid = gridAnywhere(random, 10.0);
    const Plane plane = randomPlane(random);
    const double spacing = static_cast<double>(grid.spacing);
    std::vector<Eigen::Vector3d> points;
    std::vector<std::uint8_t> given(grid.cells());
    for (int j = 0; j < grid.rows; ++j) {
      for (int i = 0; i < grid.columns; ++i) {
        for (int pair = static_cast<int>(random() % 4); pair > 0; --pair) {
          const double x = uniform(random, 0.0, 0.499) * spacing;
          const double y = uniform(random, -0.499, 0.499) * spacing;
          points.push_back(plane.point(grid.x(i) + x, grid.y(j) + y));
          points.push_back(plane.point(grid.x(i) - x, grid.y(j) - y));
          given[grid.index(i, j)] = 1;
        }
      }
    }
    std::shuffle(points.begin(), points.end(), random);
    MeanHeights heights(grid);
    for (const Eigen::Vector3d& point : points) heights.add(point);
    const CellValues found = heights.values();
    EXPECT_EQ(found.given, given);
    for (int j = 0; j < grid.rows; ++j) {
      for (int i = 0; i < grid.columns; ++i) {
        const std::size_t k = grid.index(i, j);
        if (given[k] == 0) continue;
        EXPECT_NEAR(found.values[k], plane.at(grid.x(i), grid.y(j)), 1e-5);
      }
    }
  }
}

TEST(MeanHeights, DoNotCountWhatIsBesideTheMap) {
  std::mt19937 random = seededGenerator();
  for (int scene = 0; scene < 50; ++scene) {
    const Grid grid = gridAnywhere(random, 10.0);
    MeanHeights heights(grid);
    for (int trial = 0; trial < 20; ++trial) {
      const double beyond = std::exp(uniform(random, -10.0, 600.0));
      const double x = grid.x(static_cast<int>(random() % static_cast<unsigned>(grid.columns)));
      const double y = grid.y(static_cast<int>(random() % static_cast<unsigned>(grid.rows)));
      heights.add({grid.origin_x - beyond, y, 1.0});
      heights.add({x, grid.origin_y - beyond, 1.0});
      heights.add({grid.x(grid.columns) + beyond, y, 1.0});
      heights.add({x, grid.y(grid.rows) + beyond, 1.0});
    }
    EXPECT_EQ(heights.values().given, std::vector<std::uint8_t>(grid.cells(), 0));
  }
}

/// A triangle in a plane is the plane over all middles within, and nothing elsewhere.
TEST(HighestTriangles, OfAPlaneAreThePlane) {
  std::mt19937 random = seededGenerator();
  std::size_t covered = 0;
  for (int scene = 0; scene < 300; ++scene) {
    const Grid grid = gridAnywhere(random, 10.0);
    const Plane plane = randomPlane(random);
    const auto corner = [&] {
      const double x = grid.origin_x + uniform(random, -0.5, 1.5) * grid.columns * grid.spacing;
      const double y = grid.origin_y + uniform(random, -0.5, 1.5) * grid.rows * grid.spacing;
      return plane.point(x, y);
    };
    const Eigen::Vector3d a = corner();
    const Eigen::Vector3d b = corner();
    const Eigen::Vector3d c = corner();
    HighestTriangles heights(grid);
    heights.add(a, b, c);
    HighestTriangles backwards(grid);
    backwards.add(c, b, a);
    EXPECT_EQ(heights.values().given, backwards.values().given);
    const auto turn = [](const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                         const Eigen::Vector2d& place) {
      const Eigen::Vector2d along = (to - from).head<2>();
      const Eigen::Vector2d way = place - from.head<2>();
      return (along.x() * way.y() - along.y() * way.x()) / along.norm();
    };
    for (int j = 0; j < grid.rows; ++j) {
      for (int i = 0; i < grid.columns; ++i) {
        const std::size_t k = grid.index(i, j);
        const Eigen::Vector2d place(grid.x(i), grid.y(j));
        const double distances[]{turn(a, b, place), turn(b, c, place), turn(c, a, place)};
        const auto [least, most] = std::minmax_element(std::begin(distances), std::end(distances));
        const double within = std::max(*least, -*most);  // of the side that is nearest, in either direction
        if (std::abs(within) < 1e-4 * static_cast<double>(grid.spacing)) continue;
        ASSERT_EQ(heights.values().given[k] != 0, within > 0.0);
        if (within < 0.0) continue;
        ++covered;
        EXPECT_NEAR(heights.values().values[k], plane.at(place.x(), place.y()), 1e-4);
      }
    }
  }
  EXPECT_GT(covered, 1000u);
}

TEST(HighestTriangles, CountInAnyOrder) {
  std::mt19937 random = seededGenerator();
  const Grid grid = gridAnywhere(random, 10.0);
  const double size = 2.0 * static_cast<double>(grid.spacing) * std::max(grid.columns, grid.rows);
  const Eigen::Vector3d a(grid.origin_x - size, grid.origin_y - size, 0.0);
  const Eigen::Vector3d b(grid.origin_x + 4.0 * size, grid.origin_y - size, 0.0);
  const Eigen::Vector3d c(grid.origin_x, grid.origin_y + 4.0 * size, 0.0);
  std::vector<double> levels{-3.0, -1.0, -2.0};
  std::shuffle(levels.begin(), levels.end(), random);
  HighestTriangles heights(grid);
  for (const double level : levels) {
    const Eigen::Vector3d up(0.0, 0.0, level);
    heights.add(a + up, b + up, c + up);
  }
  heights.add(a, b, a + Eigen::Vector3d(0.0, 0.0, 9.0));  // stands upright
  heights.add(a, a, a);
  EXPECT_EQ(heights.values().given, std::vector<std::uint8_t>(grid.cells(), 1));
  for (const float value : heights.values().values) EXPECT_NEAR(value, -1.0f, 1e-6f);
}

TEST(HighestTriangles, OfTooManyLayersAreRefused) {
  std::mt19937 random = seededGenerator();
  Grid grid = gridAnywhere(random, 10.0);
  grid.columns = grid.rows = 400;
  const double size = 400.0 * static_cast<double>(grid.spacing);
  const Eigen::Vector3d low(grid.origin_x, grid.origin_y, 0.0);
  const Eigen::Vector3d x(size, 0.0, 0.0);
  const Eigen::Vector3d y(0.0, size, 0.0);
  HighestTriangles heights(grid);
  for (int layer = 0; layer < 16; ++layer) {
    heights.add(low, low + x, low + y);
    heights.add(low + x, low + y, low + x + y);
  }
  const auto addLayers = [&] {
    for (int layer = 0; layer < 200; ++layer) heights.add(low, low + 2.0 * x, low + 2.0 * y);
  };
  EXPECT_THROW(addLayers(), InvalidParameter);
}

/// Deep enough to be nowhere bare, which the mesh shows as bed.
TEST(CellHeights, OfTheSandsOwnPointsAndMeshAreTheSand) {
  std::mt19937 random = seededGenerator();
  for (int scene = 0; scene < 30; ++scene) {
    Grid grid = gridAnywhere(random, 10.0);
    grid.columns += 1;  // a mesh needs two of each
    grid.rows += 1;
    const std::vector<float> waves = randomWaves(random, grid);
    const std::vector<float> others = randomWaves(random, grid);
    Fields fields;
    for (std::size_t k = 0; k < grid.cells(); ++k) {
      fields.bed.push_back(waves[k]);
      fields.depth.push_back(1.2f + others[k]);
      fields.momentum_x.push_back(0.0f);
      fields.momentum_y.push_back(0.0f);
    }
    MeanHeights points(grid);
    for (int j = 0; j < grid.rows; ++j) {
      for (int i = 0; i < grid.columns; ++i) {
        // As floats, in which ~points has them.
        points.add(
            {static_cast<float>(grid.x(i)), static_cast<float>(grid.y(j)), fields.surface(grid.index(i, j))});
      }
    }
    HighestTriangles mesh(grid);
    const SurfaceMesh surface = surfaceMesh(grid, fields);
    surface.forEachTriangle([&](const SurfaceMesh::Triangle& triangle) {
      mesh.add(surface.positions[triangle[0]], surface.positions[triangle[1]],
               surface.positions[triangle[2]]);
    });
    for (const CellValues& found : {points.values(), mesh.values()}) {
      EXPECT_EQ(found.given, std::vector<std::uint8_t>(grid.cells(), 1));
      for (std::size_t k = 0; k < grid.cells(); ++k)
        ASSERT_NEAR(found.values[k] - fields.bed[k], fields.depth[k], 2e-6);
    }
  }
}

}  // namespace
}  // namespace shallow_sand
