#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "random_grains.h"
#include "random_seed.h"

namespace shallow_sand {
namespace {

/// A slope of sand of one depth on a bed, and grains in it.
struct Slope {
  Grid grid;
  Fields fields;
  Grains grains;
  double rise_x;
  double rise_y;
  double depth;

  double surface(double x, double y) const { return rise_x * x + rise_y * y + depth; }
};

Slope randomSlope(std::mt19937& random, const GrainParameters& parameters) {
  Slope slope;
  slope.grid.columns = randomCount(random, 1, 30);
  slope.grid.rows = randomCount(random, 1, 20);
  slope.grid.spacing = static_cast<float>(uniform(random, 0.01, 0.5));
  slope.grid.origin_x = uniform(random, -10.0, 10.0);
  slope.grid.origin_y = uniform(random, -10.0, 10.0);
  slope.rise_x = uniform(random, -0.7, 0.7);
  slope.rise_y = uniform(random, -0.7, 0.7);
  slope.depth = uniform(random, 0.2, 4.0) * slope.grid.spacing;
  const std::vector<float> rest(slope.grid.cells(), 0.0f);
  slope.fields = {rest, std::vector<float>(slope.grid.cells(), static_cast<float>(slope.depth)), rest, rest};
  for (int j = 0; j < slope.grid.rows; ++j) {
    for (int i = 0; i < slope.grid.columns; ++i)
      slope.fields.bed[slope.grid.index(i, j)] =
          static_cast<float>(slope.rise_x * slope.grid.x(i) + slope.rise_y * slope.grid.y(j));
  }
  slope.grains = Grains(parameters, slope.grid);
  slope.grains.cells = startingGrains(slope.grains.grid, slope.grid, slope.fields);
  return slope;
}

/// How far (x, y) is outside of the rectangle of the centres of cells. [cells]
double beyondCentres(const Grid& grid, double x, double y) {
  const double i = (x - grid.origin_x) / static_cast<double>(grid.spacing);
  const double j = (y - grid.origin_y) / static_cast<double>(grid.spacing);
  return std::max({0.5 - i, i - (grid.columns - 0.5), 0.5 - j, j - (grid.rows - 0.5)});
}

TEST(GrainCloud, LiesBetweenSurfaceAndBed) {
  std::mt19937 random = seededGenerator();
  for (int number = 0; number < 50; ++number) {
    const Slope slope = randomSlope(random, randomGrains(random, 30));
    const GrainCloud cloud = grainCloud(slope.grid, slope.fields, slope.grains);
    ASSERT_EQ(cloud.points.size(), cloud.colors.size());
    const double tolerance = 1e-5 * (10.0 + slope.depth);
    std::size_t inside = 0;
    for (std::size_t k = 0; k < cloud.points.size(); ++k) {
      const Eigen::Vector3d point = cloud.points[k].cast<double>();
      ASSERT_TRUE((cloud.colors[k].array() >= 0.0f).all() && (cloud.colors[k].array() <= 1.0f).all());
      // Beyond the last centres the surface is level.
      if (beyondCentres(slope.grid, point.x(), point.y()) > 1e-4) continue;
      const double below = slope.surface(point.x(), point.y()) - point.z();
      ASSERT_GT(below, -tolerance);
      ASSERT_LT(below, slope.depth + tolerance);
      ++inside;
    }
    const std::size_t in_sand = static_cast<std::size_t>(std::count_if(
        slope.grains.cells.begin(), slope.grains.cells.end(), [](const Grain& g) { return !g.isBare(); }));
    // Of the lowest layer only some are above the bed.
    EXPECT_LE(cloud.points.size(), in_sand);
    const double per_volume = 1.0 / std::pow(static_cast<double>(slope.grains.grid.spacing), 3);
    const double deep = slope.grains.grid.layers * static_cast<double>(slope.grains.grid.spacing);
    const double expected = per_volume * static_cast<double>(slope.grid.cells()) * slope.grid.cellArea() *
                            std::min(deep, slope.depth);
    // Six standard deviations of the layer that the bed cuts.
    const double cut = 6.0 * std::sqrt(0.25 * slope.grains.grid.columns * slope.grains.grid.rows);
    EXPECT_NEAR(static_cast<double>(cloud.points.size()), expected, cut + 1.0);
  }
}

TEST(GrainCloud, HasNoGrainsInThinSand) {
  std::mt19937 random = seededGenerator();
  Slope slope = randomSlope(random, GrainParameters());
  const float threshold = 0.1f * slope.grid.spacing;
  slope.fields.depth.assign(slope.grid.cells(), 0.99f * threshold);
  EXPECT_TRUE(grainCloud(slope.grid, slope.fields, slope.grains).points.empty());
  slope.fields.depth.assign(slope.grid.cells(), 1.01f * threshold);
  EXPECT_FALSE(grainCloud(slope.grid, slope.fields, slope.grains).points.empty());
}

TEST(GrainCloud, LiesOnBodiesThatHoldSand) {
  std::mt19937 random = seededGenerator();
  Slope slope = randomSlope(random, GrainParameters());
  slope.fields.addLoads();
  const float cell = slope.grid.spacing;
  float highest = 0.0f;
  for (std::size_t k = 0; k < slope.grid.cells(); ++k)
    highest = std::max(highest, slope.fields.bed[k] + slope.fields.depth[k]);
  // Far above all of the slope.
  const float held = highest + 100.0f * cell;
  const float rounding = 1e-6f * held;
  for (std::size_t k = 0; k < slope.grid.cells(); ++k) {
    slope.fields.load[k] = k % 2 == 0 ? cell : 0.0f;
    slope.fields.load_elevation[k] = held;
  }
  const GrainCloud cloud = grainCloud(slope.grid, slope.fields, slope.grains);
  ASSERT_FALSE(cloud.points.empty());
  std::size_t on_body = 0;
  for (const Eigen::Vector3f& point : cloud.points) {
    // None hangs between a load and the ground.
    if (point.z() < held - cell) continue;
    EXPECT_LE(point.z(), held + cell + rounding);
    ++on_body;
  }
  EXPECT_EQ(on_body, (slope.grid.cells() + 1) / 2 * 16);
}

TEST(GrainCloud, IsColouredByOriginOrLayer) {
  std::mt19937 random = seededGenerator();
  GrainParameters parameters;
  parameters.layers = 4;
  for (const GrainColor color : {GrainColor::origin, GrainColor::layer}) {
    parameters.color = color;
    Slope slope = randomSlope(random, parameters);
    slope.fields.depth.assign(slope.grid.cells(), 10.0f * slope.grid.spacing);
    slope.grains.cells = startingGrains(slope.grains.grid, slope.grid, slope.fields);
    const GrainCloud before = grainCloud(slope.grid, slope.fields, slope.grains);
    ASSERT_EQ(before.colors.size(), slope.grains.cells.size());
    // All sand has come from one cell.
    for (std::size_t k = 0; k < slope.grains.cells.size(); ++k) slope.grains.cells[k].origin = 0;
    const GrainCloud after = grainCloud(slope.grid, slope.fields, slope.grains);
    const auto hue = [](const Eigen::Vector3f& c) { return Eigen::Vector3f(c / c.maxCoeff()); };
    for (std::size_t k = 0; k < after.colors.size(); ++k) {
      const Eigen::Vector3f& other = color == GrainColor::origin ? after.colors[0] : before.colors[k];
      ASSERT_LT((hue(after.colors[k]) - hue(other)).norm(), 0.1f);
    }
  }
}

TEST(GrainCloud, IsEmptyWithoutGrains) {
  const Slope slope{};
  EXPECT_TRUE(grainCloud(slope.grid, slope.fields, slope.grains).points.empty());
}

}  // namespace
}  // namespace shallow_sand
