#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "random_seed.h"
#include "shallow_sand/bodies/shape.h"
#include "shallow_sand/core/parameters.h"

namespace shallow_sand {
namespace {

constexpr double kPi = 3.14159265358979323846;

const Eigen::Vector3d& corner(const TriangleMesh& mesh, const std::array<int, 3>& triangle,
                              std::size_t number) {
  return mesh.vertices[static_cast<std::size_t>(triangle[number])];
}

/// Positive only when triangles face outwards.
double volume(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (const auto& triangle : mesh.triangles) {
    sum += corner(mesh, triangle, 0).dot(corner(mesh, triangle, 1).cross(corner(mesh, triangle, 2))) / 6.0;
  }
  return sum;
}

/// Every edge is passed as often one way as the other.
bool closed(const TriangleMesh& mesh) {
  std::map<std::pair<int, int>, int> passes;
  for (const auto& triangle : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const int from = triangle[i];
      const int to = triangle[(i + 1) % 3];
      passes[std::minmax(from, to)] += from < to ? 1 : -1;
    }
  }
  for (const auto& [edge, count] : passes) {
    if (count != 0) return false;
  }
  return true;
}

/// The least and the largest value of `length` over the triangles, sampled at their corners, edges and
/// inside.
template <typename Length>
std::pair<double, double> range(const TriangleMesh& mesh, Length length) {
  std::pair<double, double> found{std::numeric_limits<double>::infinity(), 0.0};
  const int parts = 6;
  for (const auto& triangle : mesh.triangles) {
    for (int i = 0; i <= parts; ++i) {
      for (int j = 0; i + j <= parts; ++j) {
        const double u = static_cast<double>(i) / parts;
        const double v = static_cast<double>(j) / parts;
        const double value = length(corner(mesh, triangle, 0) * (1.0 - u - v) +
                                    corner(mesh, triangle, 1) * u + corner(mesh, triangle, 2) * v);
        found = {std::min(found.first, value), std::max(found.second, value)};
      }
    }
  }
  return found;
}

/// Sizes from a pebble to a house: geometric_shapes' own tessellation depends on them.
double randomLength(std::mt19937& generator) {
  return std::pow(10.0, std::uniform_real_distribution<double>(-3.0, 1.0)(generator));
}

TEST(Shape, boxIsExactClosedAndFacesOutwards) {
  std::mt19937 generator = seededGenerator();
  for (int repeat = 0; repeat < 20; ++repeat) {
    const Eigen::Vector3d size(randomLength(generator), randomLength(generator), randomLength(generator));
    const TriangleMesh mesh = triangulate(Box{size});
    EXPECT_TRUE(closed(mesh));
    // A dozen products and sums of doubles.
    EXPECT_NEAR(volume(mesh), size.prod(), 1e-13 * size.prod());
    for (const Eigen::Vector3d& vertex : mesh.vertices) {
      EXPECT_TRUE(vertex.cwiseAbs().isApprox(size / 2.0));
    }
  }
}

TEST(Shape, cylinderIsClosedAndRoundWithinItsPromise) {
  std::mt19937 generator = seededGenerator();
  for (int repeat = 0; repeat < 20; ++repeat) {
    const Cylinder cylinder{randomLength(generator), randomLength(generator)};
    const TriangleMesh mesh = triangulate(cylinder);
    EXPECT_TRUE(closed(mesh));
    TriangleMesh side = mesh;
    side.triangles.clear();
    for (const auto& triangle : mesh.triangles) {
      const bool cap = corner(mesh, triangle, 0).z() == corner(mesh, triangle, 1).z() &&
                       corner(mesh, triangle, 1).z() == corner(mesh, triangle, 2).z();
      if (!cap) side.triangles.push_back(triangle);
    }
    const auto [nearest, farthest] = range(side, [](const Eigen::Vector3d& p) { return p.head<2>().norm(); });
    EXPECT_GE(nearest, 0.999 * cylinder.radius);
    EXPECT_LE(farthest, 1.001 * cylinder.radius);
    const auto [lowest, highest] = range(mesh, [](const Eigen::Vector3d& p) { return std::abs(p.z()); });
    EXPECT_GE(lowest, 0.0);
    EXPECT_NEAR(highest, cylinder.length / 2.0, 1e-12 * cylinder.length);
    // The radius enters squared.
    const double exact = kPi * cylinder.radius * cylinder.radius * cylinder.length;
    EXPECT_NEAR(volume(mesh), exact, 2.0 * 0.001 * exact);
  }
}

TEST(Shape, sphereIsClosedAndRoundWithinItsPromise) {
  std::mt19937 generator = seededGenerator();
  for (int repeat = 0; repeat < 5; ++repeat) {
    const Sphere sphere{randomLength(generator)};
    const TriangleMesh mesh = triangulate(sphere);
    EXPECT_TRUE(closed(mesh));
    const auto [nearest, farthest] = range(mesh, [](const Eigen::Vector3d& p) { return p.norm(); });
    EXPECT_GE(nearest, 0.999 * sphere.radius);
    EXPECT_LE(farthest, 1.001 * sphere.radius);
    // The radius enters cubed.
    const double exact = 4.0 / 3.0 * kPi * std::pow(sphere.radius, 3);
    EXPECT_NEAR(volume(mesh), exact, 3.0 * 0.001 * exact);
  }
}

TEST(Shape, aMeshStaysAsItIs) {
  const TriangleMesh mesh = triangulate(Box{{1.0, 2.0, 3.0}});
  const TriangleMesh same = triangulate(mesh);
  EXPECT_EQ(same.vertices, mesh.vertices);
  EXPECT_EQ(same.triangles, mesh.triangles);
}

TEST(Shape, sizesMustBePositiveAndFinite) {
  const double infinity = std::numeric_limits<double>::infinity();
  const double not_a_number = std::numeric_limits<double>::quiet_NaN();
  for (const double wrong : {0.0, -1.0, infinity, not_a_number}) {
    EXPECT_THROW(triangulate(Box{{1.0, wrong, 1.0}}), InvalidParameter);
    EXPECT_THROW(triangulate(Cylinder{wrong, 1.0}), InvalidParameter);
    EXPECT_THROW(triangulate(Cylinder{1.0, wrong}), InvalidParameter);
    EXPECT_THROW(triangulate(Sphere{wrong}), InvalidParameter);
  }
}

TEST(Shape, appendAddsAMovedCopy) {
  TriangleMesh mesh = triangulate(Box{{1.0, 1.0, 1.0}});
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translate(Eigen::Vector3d(5.0, 0.0, 0.0)).rotate(Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()));
  const TriangleMesh one = mesh;
  mesh.append(one, pose);
  ASSERT_EQ(mesh.vertices.size(), 2 * one.vertices.size());
  ASSERT_EQ(mesh.triangles.size(), 2 * one.triangles.size());
  EXPECT_TRUE(closed(mesh));
  EXPECT_NEAR(volume(mesh), 2.0, 1e-12);  // some hundred roundings of numbers up to 5
  EXPECT_EQ(mesh.vertices.back(), pose * one.vertices.back());
}

TEST(Shape, appendOfItselfDoublesIt) {
  TriangleMesh mesh = triangulate(Box{{1.0, 1.0, 1.0}});
  mesh.append(mesh, Eigen::Isometry3d::Identity());
  EXPECT_EQ(mesh.triangles.size(), 24u);
  EXPECT_NEAR(volume(mesh), 2.0, 1e-12);
}

}  // namespace
}  // namespace shallow_sand
