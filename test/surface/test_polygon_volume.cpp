#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "random_fields.h"
#include "random_seed.h"
#include "shallow_sand/surface/polygon_volume.h"

namespace shallow_sand {
namespace {

using Corners = std::vector<Eigen::Vector2d>;

struct Sand {
  Grid grid;
  Fields fields;
};

/// On some cells, and on bodies over some.
Sand randomMap(std::mt19937& random) {
  Sand sand;
  Grid& grid = sand.grid;
  grid.columns = 1 + static_cast<int>(random() % 50);
  grid.rows = 1 + static_cast<int>(random() % 50);
  grid.spacing = static_cast<float>(uniform(random, 0.02, 0.5));
  grid.origin_x = uniform(random, -10.0, 10.0);
  grid.origin_y = uniform(random, -10.0, 10.0);
  sand.fields.bed.assign(grid.cells(), 0.0f);
  sand.fields.depth.assign(grid.cells(), 0.0f);
  sand.fields.addLoads();
  for (std::size_t k = 0; k < grid.cells(); ++k) {
    sand.fields.depth[k] = static_cast<float>(uniform(random, 0.0, 2.0));
    if (random() % 3 == 0) sand.fields.load[k] = static_cast<float>(uniform(random, 0.0, 1.0));
  }
  return sand;
}

double extent(const Grid& grid) {
  return static_cast<double>(grid.spacing) * std::max(grid.columns, grid.rows);
}

Eigen::Vector2d middle(const Grid& grid) {
  return {grid.origin_x + 0.5 * grid.columns * static_cast<double>(grid.spacing),
          grid.origin_y + 0.5 * grid.rows * static_cast<double>(grid.spacing)};
}

/// Around a place, corners by growing angle at distances between two bounds: concave unless they are equal.
Corners star(std::mt19937& random, const Eigen::Vector2d& center, double least, double most) {
  const int count = 3 + static_cast<int>(random() % 30);
  Corners corners;
  for (int k = 0; k < count; ++k) {
    const double angle = 2.0 * M_PI * (k + uniform(random, 0.0, 0.9)) / count;
    corners.push_back(center +
                      uniform(random, least, most) * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  return corners;
}

/// Gauss's formula.
double areaOf(const Corners& corners) {
  double twice = 0.0;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Eigen::Vector2d a = corners[k] - corners[0];
    const Eigen::Vector2d b = corners[(k + 1) % corners.size()] - corners[0];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * std::abs(twice);
}

/// The part of a convex polygon where normal·x ≤ offset.
Corners cut(const Corners& corners, const Eigen::Vector2d& normal, double offset) {
  Corners part;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Eigen::Vector2d& a = corners[k];
    const Eigen::Vector2d& b = corners[(k + 1) % corners.size()];
    const double at_a = normal.dot(a) - offset;
    const double at_b = normal.dot(b) - offset;
    if (at_a <= 0.0) part.push_back(a);
    if ((at_a < 0.0 && at_b > 0.0) || (at_a > 0.0 && at_b < 0.0))
      part.push_back(a + at_a / (at_a - at_b) * (b - a));
  }
  return part;
}

/// Of cells one by one, each clipped to a polygon that is convex.
PolygonVolume volumeByClipping(const Sand& sand, const Corners& convex) {
  const Grid& grid = sand.grid;
  const double half = 0.5 * static_cast<double>(grid.spacing);
  PolygonVolume volume;
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      const Eigen::Vector2d center(grid.x(i), grid.y(j));
      Corners square;
      for (const Eigen::Vector2d& way : Corners{{-half, -half}, {half, -half}, {half, half}, {-half, half}})
        square.push_back(center + way);
      for (std::size_t k = 0; k < convex.size() && !square.empty(); ++k) {
        const Eigen::Vector2d side = convex[(k + 1) % convex.size()] - convex[k];
        const Eigen::Vector2d outward(side.y(), -side.x());
        square = cut(square, outward, outward.dot(convex[k]));
      }
      const double area = square.empty() ? 0.0 : areaOf(square);
      volume.area += area;
      volume.on_ground += area * static_cast<double>(sand.fields.depth[grid.index(i, j)]);
      volume.on_bodies += area * static_cast<double>(sand.fields.load[grid.index(i, j)]);
    }
  }
  return volume;
}

void expectNear(const PolygonVolume& found, const PolygonVolume& expected, double rounding) {
  EXPECT_NEAR(found.area, expected.area, rounding);
  EXPECT_NEAR(found.on_ground, expected.on_ground, rounding);
  EXPECT_NEAR(found.on_bodies, expected.on_bodies, rounding);
}

double roundingOf(const Grid& grid) { return 1e-11 * extent(grid) * extent(grid); }

TEST(PolygonVolume, OfTheWholeMapAndMoreIsAllSand) {
  std::mt19937 random = seededGenerator();
  for (int scene = 0; scene < 100; ++scene) {
    const Sand sand = randomMap(random);
    const Grid& grid = sand.grid;
    const auto sum = [&](const std::vector<float>& depths) {
      return grid.cellArea() * std::accumulate(depths.begin(), depths.end(), 0.0);
    };
    const PolygonVolume all{sum(sand.fields.depth), sum(sand.fields.load),
                            grid.cellArea() * static_cast<double>(grid.cells())};
    const Eigen::Vector2d low(grid.origin_x, grid.origin_y);
    const Eigen::Vector2d high = 2.0 * middle(grid) - low;
    const Corners map{low, {high.x(), low.y()}, high, {low.x(), high.y()}};
    expectNear(volumeInPolygon(grid, sand.fields, map), all, roundingOf(grid));
    const double more = 2.0 * extent(grid);
    const Corners around = star(random, middle(grid), 5.0 * more, 5.0 * more);
    if (around.size() < 12) continue;  // may cut the map
    expectNear(volumeInPolygon(grid, sand.fields, around), all, 100.0 * roundingOf(grid));
  }
}

TEST(PolygonVolume, OfConvexPolygonsIsThatOfClippedCells) {
  std::mt19937 random = seededGenerator();
  for (int scene = 0; scene < 150; ++scene) {
    const Sand sand = randomMap(random);
    const double size = extent(sand.grid) * std::exp(uniform(random, std::log(1e-3), std::log(2.0)));
    const Eigen::Vector2d center =
        middle(sand.grid) +
        extent(sand.grid) * Eigen::Vector2d(uniform(random, -0.6, 0.6), uniform(random, -0.6, 0.6));
    const Corners polygon = star(random, center, size, size);
    requireSimplePolygon(polygon);
    const PolygonVolume found = volumeInPolygon(sand.grid, sand.fields, polygon);
    expectNear(found, volumeByClipping(sand, polygon), roundingOf(sand.grid));
    Corners backwards = polygon;
    std::reverse(backwards.begin(), backwards.end());
    expectNear(volumeInPolygon(sand.grid, sand.fields, backwards), found, roundingOf(sand.grid));
  }
}

/// From the middle, a star falls into triangles, which are convex.
TEST(PolygonVolume, OfConcavePolygonsIsThatOfTheirParts) {
  std::mt19937 random = seededGenerator();
  for (int scene = 0; scene < 150; ++scene) {
    const Sand sand = randomMap(random);
    const double size = uniform(random, 0.05, 1.0) * extent(sand.grid);
    const Corners polygon = star(random, middle(sand.grid), 0.2 * size, size);
    requireSimplePolygon(polygon);
    PolygonVolume parts;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const Corners triangle{middle(sand.grid), polygon[k], polygon[(k + 1) % polygon.size()]};
      const PolygonVolume part = volumeInPolygon(sand.grid, sand.fields, triangle);
      // With few corners the middle may lie beside the star.
      const Eigen::Vector2d a = triangle[1] - triangle[0];
      const Eigen::Vector2d b = triangle[2] - triangle[0];
      const double sign = a.x() * b.y() - a.y() * b.x() < 0.0 ? -1.0 : 1.0;
      parts.area += sign * part.area;
      parts.on_ground += sign * part.on_ground;
      parts.on_bodies += sign * part.on_bodies;
    }
    // A triangle that the middle lies far beside runs the other way round.
    if (parts.area < 0.0) parts = {-parts.on_ground, -parts.on_bodies, -parts.area};
    expectNear(volumeInPolygon(sand.grid, sand.fields, polygon), parts, 10.0 * roundingOf(sand.grid));
  }
}

TEST(PolygonVolume, IsThatOfTwoPartsAlongAnyCut) {
  std::mt19937 random = seededGenerator();
  for (int scene = 0; scene < 150; ++scene) {
    const Sand sand = randomMap(random);
    const double size = uniform(random, 0.1, 1.5) * extent(sand.grid);
    const Corners polygon = star(random, middle(sand.grid), size, size);
    const double angle = uniform(random, 0.0, 2.0 * M_PI);
    const Eigen::Vector2d normal(std::cos(angle), std::sin(angle));
    const double offset = normal.dot(middle(sand.grid)) + uniform(random, -0.5, 0.5) * size;
    const PolygonVolume all = volumeInPolygon(sand.grid, sand.fields, polygon);
    PolygonVolume parts;
    for (const Corners& part : {cut(polygon, normal, offset), cut(polygon, -normal, -offset)}) {
      if (part.size() < 3) continue;
      const PolygonVolume volume = volumeInPolygon(sand.grid, sand.fields, part);
      parts = {parts.on_ground + volume.on_ground, parts.on_bodies + volume.on_bodies,
               parts.area + volume.area};
    }
    expectNear(parts, all, roundingOf(sand.grid));
  }
}

/// Sides along the lines between cells, where a side has no cell of its own.
TEST(PolygonVolume, CountsWholeCellsWhole) {
  std::mt19937 random = seededGenerator();
  Sand sand = randomMap(random);
  sand.grid.columns = sand.grid.rows = 8;
  sand.grid.spacing = 0.25f;  // so that all sums are exact
  sand.grid.origin_x = sand.grid.origin_y = -1.0;
  sand.fields.load.clear();
  sand.fields.depth.assign(64, 0.5f);
  for (int trial = 0; trial < 100; ++trial) {
    const int left = static_cast<int>(random() % 8);
    const int low = static_cast<int>(random() % 8);
    const int right = left + 1 + static_cast<int>(random() % 8);
    const int high = low + 1 + static_cast<int>(random() % 8);
    const auto at = [](int i, int j) { return Eigen::Vector2d(-1.0 + 0.25 * i, -1.0 + 0.25 * j); };
    const Corners rectangle{at(left, low), at(right, low), at(right, high), at(left, high)};
    const int cells = (std::min(right, 8) - left) * (std::min(high, 8) - low);
    const PolygonVolume volume = volumeInPolygon(sand.grid, sand.fields, rectangle);
    EXPECT_EQ(volume.area, 0.0625 * cells);
    EXPECT_EQ(volume.on_ground, 0.5 * 0.0625 * cells);
    EXPECT_EQ(volume.on_bodies, 0.0);
  }
}

TEST(PolygonVolume, IsNothingBesideTheMap) {
  std::mt19937 random = seededGenerator();
  for (int scene = 0; scene < 50; ++scene) {
    const Sand sand = randomMap(random);
    const double away = 3.0 * extent(sand.grid);
    const double angle = uniform(random, 0.0, 2.0 * M_PI);
    const Eigen::Vector2d center =
        middle(sand.grid) + away * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    const PolygonVolume volume =
        volumeInPolygon(sand.grid, sand.fields, star(random, center, 0.1, extent(sand.grid)));
    expectNear(volume, {}, roundingOf(sand.grid));
  }
}

TEST(PolygonVolume, RefusesWhatIsNoSimplePolygon) {
  const double infinite = std::numeric_limits<double>::infinity();
  for (const Corners& bad : std::vector<Corners>{{},
                                                 {{0, 0}, {1, 0}},
                                                 {{0, 0}, {1, 0}, {1, 0}, {0, 0}},
                                                 {{0, 0}, {1, 0}, {2, 0}},                  // no area
                                                 {{0, 0}, {1, 1}, {1, 0}, {0, 1}},          // crosses itself
                                                 {{0, 0}, {2, 0}, {2, 2}, {1, 0}, {0, 2}},  // touches itself
                                                 {{0, 0}, {2, 0}, {3, 0}, {2, 0}, {2, 2}},  // a spike
                                                 {{0, 0}, {1, 0}, {std::nan(""), 1}},
                                                 {{0, 0}, {1, 0}, {1, infinite}},
                                                 {{0, 0}, {1, 0}, {1, 1e9}},
                                                 Corners(10001, Eigen::Vector2d(0, 0))}) {
    EXPECT_THROW(requireSimplePolygon(bad), InvalidParameter);
  }
}

/// Of corners on a circle only one order crosses nothing, from any of them on and in either direction.
TEST(PolygonVolume, RefusesPolygonsThatCrossThemselves) {
  std::mt19937 random = seededGenerator();
  for (int scene = 0; scene < 200; ++scene) {
    Corners polygon = star(random, {1.0, 2.0}, 1.0, 1.0);
    if (polygon.size() < 5) continue;
    requireSimplePolygon(polygon);
    const std::size_t k = random() % polygon.size();
    const std::size_t other = (k + 1 + random() % (polygon.size() - 1)) % polygon.size();
    std::swap(polygon[k], polygon[other]);
    EXPECT_THROW(requireSimplePolygon(polygon), InvalidParameter);
  }
}

TEST(PolygonVolume, TakesPolygonsThatAreClosedOrSayACornerTwice) {
  std::mt19937 random = seededGenerator();
  const Sand sand = randomMap(random);
  const Corners triangle = star(random, middle(sand.grid), 0.2, 0.2);
  Corners closed = triangle;
  closed.insert(closed.begin() + 1, closed[1]);
  closed.push_back(closed.front());
  requireSimplePolygon(closed);
  expectNear(volumeInPolygon(sand.grid, sand.fields, closed),
             volumeInPolygon(sand.grid, sand.fields, triangle), roundingOf(sand.grid));
}

}  // namespace
}  // namespace shallow_sand
