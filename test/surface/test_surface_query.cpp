#include <gtest/gtest.h>

#include <cmath>

#include "random_fields.h"
#include "random_seed.h"
#include "shallow_sand/surface/surface_query.h"

namespace shallow_sand {
namespace {

double extentX(const Grid& grid) { return grid.columns * static_cast<double>(grid.spacing); }
double extentY(const Grid& grid) { return grid.rows * static_cast<double>(grid.spacing); }

Eigen::Vector2d randomPlaceOn(std::mt19937& random, const Grid& grid) {
  return {grid.origin_x + uniform(random, 0.0, extentX(grid)),
          grid.origin_y + uniform(random, 0.0, extentY(grid))};
}

Fields noSand(const Grid& grid) {
  Fields fields;
  for (auto* values : {&fields.bed, &fields.depth, &fields.momentum_x, &fields.momentum_y})
    values->assign(grid.cells(), 0.0f);
  return fields;
}

TEST(SurfaceQuery, IsExactOnPlanesUpToTheEdges) {
  std::mt19937 random = seededGenerator();
  for (int scene = 0; scene < 200; ++scene) {
    const Grid grid = gridAnywhere(random, 100.0);
    // Of one cell across, nothing tells a slope.
    const double slope_x = grid.columns > 1 ? uniform(random, -1.0, 1.0) : 0.0;
    const double slope_y = grid.rows > 1 ? uniform(random, -1.0, 1.0) : 0.0;
    const double depth_slope = grid.columns > 1 ? uniform(random, -1.0, 1.0) : 0.0;
    const auto surface = [&](double x, double y) {
      return slope_x * (x - grid.origin_x) + slope_y * (y - grid.origin_y);
    };
    // Deep enough to be nowhere less than nothing.
    const auto depth = [&](double x) { return 40.0 + depth_slope * (x - grid.origin_x); };
    Fields fields = noSand(grid);
    for (int j = 0; j < grid.rows; ++j) {
      for (int i = 0; i < grid.columns; ++i) {
        const std::size_t k = grid.index(i, j);
        fields.depth[k] = static_cast<float>(depth(grid.x(i)));
        fields.bed[k] = static_cast<float>(surface(grid.x(i), grid.y(j)) - depth(grid.x(i)));
      }
    }
    // Floats of up to 100 m, over a cell.
    const double rounding = 2e-5;
    for (int trial = 0; trial < 50; ++trial) {
      const Eigen::Vector2d place = randomPlaceOn(random, grid);
      const auto found = surfaceAt(grid, fields, place);
      ASSERT_TRUE(found);
      EXPECT_NEAR(found->height, surface(place.x(), place.y()), rounding);
      EXPECT_NEAR(found->depth, depth(place.x()), rounding);
      const Eigen::Vector3d normal = Eigen::Vector3d(-slope_x, -slope_y, 1.0).normalized();
      EXPECT_LT((found->normal - normal).norm(), 4.0 * rounding / static_cast<double>(grid.spacing));
    }
  }
}

TEST(SurfaceQuery, IsTheCellsOwnInItsMiddle) {
  std::mt19937 random = seededGenerator();
  for (int scene = 0; scene < 50; ++scene) {
    const Grid grid = gridAnywhere(random, 100.0);
    Fields fields = noSand(grid);
    fields.addLoads();
    for (std::size_t k = 0; k < grid.cells(); ++k) {
      fields.bed[k] = static_cast<float>(uniform(random, -1.0, 1.0));
      fields.depth[k] = random() % 3 == 0 ? 0.0f : static_cast<float>(uniform(random, 0.0, 1.0));
      fields.load[k] = random() % 3 == 0 ? static_cast<float>(uniform(random, 0.0, 1.0)) : 0.0f;
      fields.load_elevation[k] = 3.0f;
    }
    for (int trial = 0; trial < 50; ++trial) {
      const int i = static_cast<int>(random() % static_cast<unsigned>(grid.columns));
      const int j = static_cast<int>(random() % static_cast<unsigned>(grid.rows));
      const auto found = surfaceAt(grid, fields, {grid.x(i), grid.y(j)});
      ASSERT_TRUE(found);
      EXPECT_NEAR(found->height, fields.surface(grid.index(i, j)), 1e-10);
      EXPECT_NEAR(found->depth, fields.allDepth(grid.index(i, j)), 1e-10);
      EXPECT_NEAR(found->normal.norm(), 1.0, 1e-12);
      EXPECT_GT(found->normal.z(), 0.0);
    }
  }
}

TEST(SurfaceQuery, KnowsWhatIsBesideTheMap) {
  std::mt19937 random = seededGenerator();
  for (int scene = 0; scene < 50; ++scene) {
    const Grid grid = gridAnywhere(random, 100.0);
    const Fields fields = noSand(grid);
    const Eigen::Vector2d inside = randomPlaceOn(random, grid);
    const double beyond = uniform(random, 1e-6, 10.0);
    EXPECT_TRUE(surfaceAt(grid, fields, inside));
    EXPECT_FALSE(surfaceAt(grid, fields, {grid.origin_x - beyond, inside.y()}));
    EXPECT_FALSE(surfaceAt(grid, fields, {grid.origin_x + extentX(grid) + beyond, inside.y()}));
    EXPECT_FALSE(surfaceAt(grid, fields, {inside.x(), grid.origin_y - beyond}));
    EXPECT_FALSE(surfaceAt(grid, fields, {inside.x(), grid.origin_y + extentY(grid) + beyond}));
    EXPECT_FALSE(surfaceAt(grid, fields, {std::nan(""), inside.y()}));
  }
}

}  // namespace
}  // namespace shallow_sand
