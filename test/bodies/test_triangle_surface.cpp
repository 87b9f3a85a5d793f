#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <vector>

#include "random_bodies.h"
#include "random_seed.h"
#include "shallow_sand/bodies/shape.h"
#include "shallow_sand/device/instruction_set.h"
#include "triangle_surface.h"

namespace shallow_sand {
namespace {

Eigen::Vector3d randomVector(std::mt19937& random, double most) {
  const double x = uniform(random, -most, most);
  const double y = uniform(random, -most, most);
  return {x, y, uniform(random, -most, most)};
}

/// From one to four shapes that overlap; with holes, faces that are turned and faces that are there twice.
TriangleMesh randomMesh(std::mt19937& random) {
  const double scale = std::pow(10.0, uniform(random, -3.0, 3.0));
  TriangleMesh mesh;
  for (int part = randomCount(random, 1, 4); part > 0; --part) {
    const double length = uniform(random, 0.1, 0.5);
    const std::array<Shape, 3> shapes{Box{{length, 0.2, 0.3}}, Cylinder{length, 0.3}, Sphere{length}};
    Eigen::Isometry3d pose(randomRotation(random));
    pose.translation() = randomVector(random, 0.3);
    mesh.append(triangulate(shapes[random() % 3]), pose);
  }
  for (Eigen::Vector3d& vertex : mesh.vertices) vertex *= scale;
  const double lost = random() % 3 == 0 ? 0.0 : uniform(random, 0.0, 0.95);
  const double turned = random() % 2 == 0 ? 0.0 : uniform(random, 0.0, 0.5);
  const double doubled = random() % 2 == 0 ? 0.0 : uniform(random, 0.0, 0.5);
  std::vector<std::array<int, 3>> kept;
  for (std::array<int, 3> triangle : mesh.triangles) {
    if (uniform(random, 0.0, 1.0) < lost) continue;
    if (uniform(random, 0.0, 1.0) < turned) std::swap(triangle[0], triangle[1]);
    kept.push_back(triangle);
    if (uniform(random, 0.0, 1.0) < doubled) kept.push_back(triangle);
  }
  if (!kept.empty()) mesh.triangles = kept;
  return mesh;
}

/// On the mesh's corners, edges and faces, close to them, round about and far away.
Eigen::Vector3d randomPoint(std::mt19937& random, const TriangleMesh& mesh) {
  const std::array<int, 3>& triangle = mesh.triangles[random() % mesh.triangles.size()];
  const auto corner = [&](std::size_t i) { return mesh.vertices[static_cast<std::size_t>(triangle[i])]; };
  const double size = corner(0).norm() + corner(1).norm();
  const double part = uniform(random, 0.0, 1.0);
  switch (random() % 6) {
    case 0:
      return corner(0);
    case 1:
      return corner(0) + part * (corner(1) - corner(0));
    case 2:
      return (corner(0) + corner(1) + corner(2)) / 3.0;
    case 3:
      return corner(0) + randomVector(random, size * std::pow(10.0, uniform(random, -15.0, -1.0)));
    case 4:
      return randomVector(random, size);
    default:
      return randomVector(random, 1e3 * size);
  }
}

bool sameBits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

TEST(TriangleSurface, windingNumbersAreTheSameBitsWithEveryInstructionSet) {
  std::mt19937 random = seededGenerator();
  const std::vector<InstructionSet> sets = instructionSets();
  if (sets.size() < 2) GTEST_SKIP() << "this machine has one set of instructions";
  for (int repeat = 0; repeat < 20; ++repeat) {
    const TriangleMesh mesh = randomMesh(random);
    std::vector<Eigen::Vector3d> points;
    // Some in groups that lie together: then all of them see a series, or none.
    while (points.size() < 100) {
      const Eigen::Vector3d point = randomPoint(random, mesh);
      const double apart = 0.01 * point.norm();
      for (int more = randomCount(random, 0, 8); more >= 0; --more)
        points.push_back(more == 0 ? point : Eigen::Vector3d(point + randomVector(random, apart)));
    }
    const auto one_by_one = [&](const TriangleSurface& surface) {
      std::vector<double> numbers;
      for (const Eigen::Vector3d& point : points) numbers.push_back(surface.windingNumber(point));
      return numbers;
    };
    const TriangleSurface baseline(mesh, InstructionSet::baseline);
    const std::vector<double> together = baseline.windingNumbers(points);
    const std::vector<double> alone = one_by_one(baseline);
    EXPECT_TRUE(std::all_of(together.begin(), together.end(), [](double w) { return std::isfinite(w); }));
    EXPECT_TRUE(std::all_of(alone.begin(), alone.end(), [](double w) { return std::isfinite(w); }));
    for (const InstructionSet set : sets) {
      const TriangleSurface surface(mesh, set);
      EXPECT_TRUE(sameBits(surface.windingNumbers(points), together)) << toString(set);
      EXPECT_TRUE(sameBits(one_by_one(surface), alone)) << toString(set);
    }
    EXPECT_TRUE(sameBits(TriangleSurface(mesh).windingNumbers(points), together));
  }
}

}  // namespace
}  // namespace shallow_sand
