#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <set>

#include "random_seed.h"
#include "shallow_sand/rviz/patch_grid.h"
#include "shallow_sand/rviz/sand_ray.h"
#include "shallow_sand/rviz/sand_vertices.h"

namespace shallow_sand {
namespace {

HeightField flatMap(std::uint32_t columns, std::uint32_t rows, float depth) {
  HeightField map;
  map.columns = columns;
  map.rows = rows;
  map.spacing = 0.05f;
  map.bed.assign(std::size_t{columns} * rows, 0.0f);
  map.depth.assign(std::size_t{columns} * rows, depth);
  return map;
}

template <class Random>
HeightField randomMap(Random& random) {
  std::uniform_int_distribution<std::uint32_t> size(2, 150);
  std::uniform_real_distribution<float> elevation(-0.2f, 0.2f);
  HeightField map = flatMap(size(random), size(random), 0.0f);
  map.origin_x = static_cast<double>(elevation(random));
  map.origin_y = static_cast<double>(elevation(random));
  for (float& bed : map.bed) bed = elevation(random);
  for (float& depth : map.depth) depth = std::max(elevation(random), 0.0f);
  return map;
}

CellRectangle all(const HeightField& map) { return {0, 0, map.columns, map.rows}; }

Eigen::Vector3f vector(const float (&values)[3]) { return {values[0], values[1], values[2]}; }

/// Normal of a triangle, from the order of its corners.
Eigen::Vector3f turn(const std::vector<SandVertex>& vertices, const std::vector<std::uint32_t>& corners,
                     std::size_t k) {
  const Eigen::Vector3f a = vector(vertices[corners[k]].position);
  const Eigen::Vector3f b = vector(vertices[corners[k + 1]].position);
  const Eigen::Vector3f c = vector(vertices[corners[k + 2]].position);
  return (b - a).cross(c - a);
}

TEST(SandVertices, TrianglesCoverTheMapOnceAndFaceUpwards) {
  std::mt19937 random = seededGenerator();
  for (int trial = 0; trial < 20; ++trial) {
    const HeightField map = randomMap(random);
    const std::vector<SandVertex> vertices = groundVertices(map, all(map), {});
    for (const std::uint32_t stride : {1u, 2u, 3u, 8u}) {
      const std::vector<std::uint32_t> corners = gridTriangles(map.columns, map.rows, stride);
      double area = 0.0;
      for (std::size_t k = 0; k < corners.size(); k += 3) {
        const float doubled = turn(vertices, corners, k).z();
        ASSERT_GT(doubled, 0.0f);
        area += 0.5 * static_cast<double>(doubled);
      }
      const double expected = (map.columns - 1) * (map.rows - 1) * 0.05 * 0.05;
      EXPECT_NEAR(area, expected, 1e-4 * expected) << "stride " << stride;
    }
  }
}

TEST(SandVertices, SidesFaceOutwards) {
  std::mt19937 random = seededGenerator();
  HeightField map = randomMap(random);
  for (float& depth : map.depth) depth += 0.1f;
  const std::pair<Side, Eigen::Vector3f> sides[] = {{Side::x_min, -Eigen::Vector3f::UnitX()},
                                                    {Side::x_max, Eigen::Vector3f::UnitX()},
                                                    {Side::y_min, -Eigen::Vector3f::UnitY()},
                                                    {Side::y_max, Eigen::Vector3f::UnitY()}};
  for (const auto& [side, outwards] : sides) {
    const std::vector<SandVertex> vertices = sideVertices(map, side);
    const std::vector<std::uint32_t> corners = sideTriangles(map, side);
    ASSERT_FALSE(corners.empty());
    for (std::size_t k = 0; k < corners.size(); k += 3) {
      EXPECT_GT(turn(vertices, corners, k).dot(outwards), 0.0f);
      EXPECT_EQ(vector(vertices[corners[k]].normal), outwards);
    }
  }
}

TEST(SandVertices, NormalsOfAPlaneAreExactAndAllOfTheSkyIsSeenFromLevelGround) {
  HeightField map = flatMap(20, 30, 0.1f);
  for (const SandVertex& vertex : groundVertices(map, all(map), {})) EXPECT_EQ(vertex.openness, 1.0f);
  for (std::uint32_t j = 0; j < map.rows; ++j) {
    for (std::uint32_t i = 0; i < map.columns; ++i)
      map.bed[j * map.columns + i] = 0.05f * (0.3f * static_cast<float>(i) - 0.2f * static_cast<float>(j));
  }
  const Eigen::Vector3f normal = Eigen::Vector3f(-0.3f, 0.2f, 1.0f).normalized();
  for (const SandVertex& vertex : groundVertices(map, all(map), {}))
    EXPECT_LT((vector(vertex.normal) - normal).norm(), 1e-5f);
}

/// The line at which level sand ends on a tilted bed is where it ends in truth, though depths are never
/// negative.
TEST(SandVertices, ShoreOfLevelSandLiesWhereItShould) {
  HeightField map = flatMap(40, 3, 0.0f);
  const float slope = 0.23f;
  const float level = 1.137f * slope;
  for (std::uint32_t cell = 0; cell < map.depth.size(); ++cell) {
    map.bed[cell] = slope * (static_cast<float>(cell % map.columns) + 0.5f) * map.spacing;
    map.depth[cell] = std::max(level - map.bed[cell], 0.0f);
  }
  const std::vector<SandVertex> vertices = groundVertices(map, all(map), {});
  const float shore = 0.1f * map.spacing;
  int shores = 0;
  for (std::uint32_t i = map.columns; i + 1 < 2 * map.columns; ++i) {
    const SandVertex& wet = vertices[i];
    const SandVertex& dry = vertices[i + 1];
    if (wet.depth < shore || dry.depth >= shore) continue;
    const float share = (wet.depth - shore) / (wet.depth - dry.depth);
    EXPECT_NEAR(wet.position[0] + share * map.spacing, (level - shore) / slope, 1e-4f);
    ++shores;
  }
  EXPECT_EQ(shores, 1);
}

TEST(SandVertices, ASheetOfLoadDoesNotHangDownToTheGround) {
  HeightField map = flatMap(20, 20, 0.1f);
  EXPECT_TRUE(loadSheet(map, all(map)).triangles.empty());
  map.load.assign(map.depth.size(), 0.0f);
  map.load_elevation.assign(map.depth.size(), 0.0f);
  EXPECT_TRUE(loadSheet(map, all(map)).triangles.empty());
  for (std::uint32_t j = 5; j < 10; ++j) {
    for (std::uint32_t i = 7; i < 13; ++i) {
      map.load[j * 20 + i] = 0.2f;
      map.load_elevation[j * 20 + i] = 1.0f;
    }
  }
  const LoadSheet sheet = loadSheet(map, all(map));
  EXPECT_EQ(sheet.triangles.size(), 3u * 2u * 4u * 5u);
  for (const std::uint32_t corner : sheet.triangles)
    EXPECT_FLOAT_EQ(sheet.vertices[corner].position[2], 1.2f);
}

TEST(PatchGrid, WhatIsNotTouchedStaysTheSameInEveryBit) {
  std::mt19937 random = seededGenerator();
  for (int trial = 0; trial < 20; ++trial) {
    HeightField map = randomMap(random);
    const HeightField before = map;
    const PatchGrid grid(map);
    const auto pick = [&](std::uint32_t below) {
      return std::uniform_int_distribution<std::uint32_t>(0, below - 1)(random);
    };
    const std::uint32_t column = pick(map.columns);
    const std::uint32_t row = pick(map.rows);
    const CellRectangle cells{column, row, 1 + pick(map.columns - column), 1 + pick(map.rows - row)};
    for (std::uint32_t j = cells.row; j < cells.row + cells.rows; ++j) {
      for (std::uint32_t i = cells.column; i < cells.column + cells.columns; ++i)
        map.depth[j * map.columns + i] += 0.5f;
    }
    const std::vector<PatchGrid::Number> list = grid.touchedBy(cells);
    const std::set<PatchGrid::Number> touched(list.begin(), list.end());
    EXPECT_EQ(touched.size(), list.size());
    std::vector<int> covered(map.depth.size(), 0);
    for (const PatchGrid::Number& patch : grid.touchedBy(all(map))) {
      const CellRectangle own = grid.verticesOf(patch);
      for (std::uint32_t j = own.row; j < own.row + own.rows; ++j) {
        for (std::uint32_t i = own.column; i < own.column + own.columns; ++i)
          covered[j * map.columns + i] = 1;
      }
      if (touched.count(patch) > 0) continue;
      const std::vector<SandVertex> old_vertices = groundVertices(before, own, {});
      const std::vector<SandVertex> new_vertices = groundVertices(map, own, {});
      EXPECT_EQ(
          std::memcmp(old_vertices.data(), new_vertices.data(), old_vertices.size() * sizeof(SandVertex)), 0);
    }
    EXPECT_EQ(std::count(covered.begin(), covered.end(), 0), 0);
  }
}

TEST(SandRay, MeetsAPlaneWhereItIs) {
  std::mt19937 random = seededGenerator();
  HeightField map = flatMap(60, 40, 0.1f);
  map.origin_x = 5.0;
  map.origin_y = -3.0;
  for (std::uint32_t cell = 0; cell < map.depth.size(); ++cell)
    map.bed[cell] = 0.02f * static_cast<float>(cell % map.columns);
  const auto elevation = [&](float x) { return 0.1f + 0.02f * ((x - 5.0f) / map.spacing - 0.5f); };
  std::uniform_real_distribution<float> share(0.1f, 0.9f);
  std::uniform_real_distribution<float> sideways(-2.0f, 2.0f);
  for (int trial = 0; trial < 200; ++trial) {
    const float x = 5.0f + share(random) * 3.0f;
    const Ogre::Vector3 target(x, -3.0f + share(random) * 2.0f, elevation(x));
    const Ogre::Vector3 eye = target + Ogre::Vector3(sideways(random), sideways(random), 3.0f);
    const Ogre::Ray ray(eye, (target - eye).normalisedCopy());
    const std::optional<float> met = meetSand(map, ray);
    ASSERT_TRUE(met);
    EXPECT_LT(ray.getPoint(*met).distance(target), 1e-3f);
  }
  EXPECT_FALSE(meetSand(map, {Ogre::Vector3(6.0f, -2.0f, 3.0f), Ogre::Vector3::UNIT_Z}));
  EXPECT_FALSE(meetSand(map, {Ogre::Vector3(0.0f, 0.0f, 3.0f), Ogre::Vector3::NEGATIVE_UNIT_Z}));
}

}  // namespace
}  // namespace shallow_sand
