#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "random_seed.h"
#include "shallow_sand/bodies/body_geometry.h"
#include "shallow_sand/bodies/distance_field.h"
#include "shallow_sand/core/parameters.h"

namespace shallow_sand {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kExactReach = 2.0;   ///< in spacings, as the header promises
constexpr double kSeriesError = 0.1;  ///< of the winding number, as the header tells

double between(std::mt19937& generator, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(generator);
}

Eigen::Vector3d randomVector(std::mt19937& generator, double low, double high) {
  return {between(generator, low, high), between(generator, low, high), between(generator, low, high)};
}

Eigen::Isometry3d randomPose(std::mt19937& generator) {
  std::normal_distribution<double> normal;
  Eigen::Quaterniond rotation(normal(generator), normal(generator), normal(generator), normal(generator));
  return Eigen::Translation3d(randomVector(generator, -1.0, 1.0)) * rotation.normalized();
}

// Signed distances in closed form: what a field must say.

double boxDistance(const Eigen::Vector3d& size, const Eigen::Vector3d& point) {
  const Eigen::Array3d beyond = point.array().abs() - size.array() / 2.0;
  return beyond.max(0.0).matrix().norm() + std::min(beyond.maxCoeff(), 0.0);
}

double cylinderDistance(const Cylinder& cylinder, const Eigen::Vector3d& point) {
  const Eigen::Array2d beyond(point.head<2>().norm() - cylinder.radius,
                              std::abs(point.z()) - cylinder.length / 2.0);
  return beyond.max(0.0).matrix().norm() + std::min(beyond.maxCoeff(), 0.0);
}

double triangleDistance(const std::array<Eigen::Vector3d, 3>& triangle, const Eigen::Vector3d& point) {
  const Eigen::Vector3d normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]).normalized();
  double nearest = std::numeric_limits<double>::infinity();
  bool above_inside = true;
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d along = triangle[(i + 1) % 3] - triangle[i];
    const Eigen::Vector3d to_point = point - triangle[i];
    if (normal.cross(along).dot(to_point) < 0.0) above_inside = false;
    const double part = std::clamp(to_point.dot(along) / along.squaredNorm(), 0.0, 1.0);
    nearest = std::min(nearest, (to_point - part * along).norm());
  }
  return above_inside ? std::abs(normal.dot(point - triangle[0])) : nearest;
}

std::array<Eigen::Vector3d, 3> corners(const TriangleMesh& mesh, const std::array<int, 3>& triangle) {
  const auto vertex = [&](std::size_t i) { return mesh.vertices[static_cast<std::size_t>(triangle[i])]; };
  return {vertex(0), vertex(1), vertex(2)};
}

double meshDistance(const TriangleMesh& mesh, const Eigen::Vector3d& point) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const auto& triangle : mesh.triangles) {
    nearest = std::min(nearest, triangleDistance(corners(mesh, triangle), point));
  }
  return nearest;
}

/// By the spherical excess of each triangle seen from `point`: the sum of its dihedral angles less π.
double windingNumber(const TriangleMesh& mesh, const Eigen::Vector3d& point) {
  double sum = 0.0;
  for (const auto& triangle : mesh.triangles) {
    std::array<Eigen::Vector3d, 3> seen = corners(mesh, triangle);
    for (Eigen::Vector3d& direction : seen) direction = (direction - point).normalized();
    double excess = -kPi;
    for (std::size_t i = 0; i < 3; ++i) {
      const Eigen::Vector3d first = seen[i].cross(seen[(i + 1) % 3]);
      const Eigen::Vector3d second = seen[i].cross(seen[(i + 2) % 3]);
      excess += std::atan2(first.cross(second).norm(), first.dot(second));
    }
    sum += seen[0].dot(seen[1].cross(seen[2])) > 0.0 ? excess : -excess;
  }
  return sum / (4.0 * kPi);
}

template <typename Visit>
void forEachSample(const DistanceField& field, Visit visit) {
  std::size_t index = 0;
  for (int k = 0; k < field.samples[2]; ++k) {
    for (int j = 0; j < field.samples[1]; ++j) {
      for (int i = 0; i < field.samples[0]; ++i) {
        visit(Eigen::Vector3d(field.origin + field.spacing * Eigen::Vector3d(i, j, k)),
              static_cast<double>(field.distance[index++]));
      }
    }
  }
}

/// A float's rounding of lengths up to two metres, which is also far above that of the doubles before it.
constexpr double kRounding = 2.0 * 6e-8 + 1e-9;

/// The header's promise for all samples, `off`: how far the mesh lies from the exact surface [m].
template <typename Exact>
void expectPromise(const DistanceField& field, Exact exact, double off) {
  const double tolerance = off + kRounding;
  const double reach = kExactReach * field.spacing;
  int wrong = 0;
  int inside = 0;
  forEachSample(field, [&](const Eigen::Vector3d& point, double found) {
    const double distance = exact(point);
    const bool side_right = std::abs(distance) <= tolerance || std::signbit(found) == std::signbit(distance);
    const bool near = std::abs(distance) <= reach - tolerance;
    const bool length_right = near ? std::abs(std::abs(found) - std::abs(distance)) <= tolerance
                                   : std::abs(found) <= std::abs(distance) + tolerance &&
                                         std::abs(found) >= reach - 2.0 * tolerance;
    inside += found < 0.0 ? 1 : 0;
    if (side_right && length_right) return;
    if (++wrong <= 5)
      ADD_FAILURE() << "at " << point.transpose() << ": " << found << ", exactly " << distance;
  });
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(inside, 0);
}

TEST(DistanceField, boxKeepsThePromise) {
  std::mt19937 generator = seededGenerator();
  for (int repeat = 0; repeat < 5; ++repeat) {
    const Eigen::Vector3d size = randomVector(generator, 0.1, 1.0);
    const DistanceField field = computeDistanceField(triangulate(Box{size}), between(generator, 0.02, 0.05));
    expectPromise(
        field, [&](const Eigen::Vector3d& point) { return boxDistance(size, point); }, 0.0);
  }
}

TEST(DistanceField, sphereKeepsThePromise) {
  std::mt19937 generator = seededGenerator();
  const Sphere sphere{between(generator, 0.1, 0.5)};
  const DistanceField field = computeDistanceField(triangulate(sphere), 0.1 * sphere.radius);
  expectPromise(
      field, [&](const Eigen::Vector3d& point) { return point.norm() - sphere.radius; },
      0.001 * sphere.radius);
}

TEST(DistanceField, cylinderKeepsThePromise) {
  std::mt19937 generator = seededGenerator();
  const Cylinder cylinder{between(generator, 0.1, 0.5), between(generator, 0.1, 0.5)};
  const DistanceField field = computeDistanceField(triangulate(cylinder), 0.02);
  expectPromise(
      field, [&](const Eigen::Vector3d& point) { return cylinderDistance(cylinder, point); },
      0.001 * cylinder.radius);
}

/// What stands for a point where FCL takes none: a triangle or a sphere no part of which is farther from it.
constexpr double kPointRadius = 1e-9;

/// Distances to a mesh as FCL finds them from triangle to triangle: in closed form, with other code than its
/// Project, from which fields are computed. Not those of a sphere: they share that code, and are left unset
/// where it touches the mesh.
class FclMesh {
 public:
  explicit FclMesh(const TriangleMesh& mesh) {
    mesh_.beginModel(static_cast<int>(mesh.triangles.size()));
    for (const auto& triangle : mesh.triangles) {
      const auto [a, b, c] = corners(mesh, triangle);
      mesh_.addTriangle(a, b, c);
    }
    mesh_.endModel();
    point_.beginModel(1);
    // No side is parallel to one of a mesh: FCL then takes the first pair of sides for the nearest one.
    point_.addTriangle(kPointRadius * Eigen::Vector3d(0.1, 0.5, 0.8),
                       kPointRadius * Eigen::Vector3d(-0.7, 0.2, -0.6),
                       kPointRadius * Eigen::Vector3d(0.6, -0.7, -0.2));
    point_.endModel();
  }

  /// Wrong by kPointRadius at most.
  double distance(const Eigen::Vector3d& point) const {
    const fcl::DistanceRequestd request;
    fcl::DistanceResultd result;
    return fcl::distance(&mesh_, fcl::Transform3d::Identity(), &point_,
                         fcl::Transform3d(Eigen::Translation3d(point)), request, result);
  }

 private:
  fcl::BVHModel<fcl::OBBRSSd> mesh_;
  fcl::BVHModel<fcl::OBBRSSd> point_;
};

/// A closed mesh that overlaps itself nowhere, and what is inside of it.
struct Solid {
  TriangleMesh mesh;
  std::function<bool(const Eigen::Vector3d&)> contains;
  double off;  ///< how far the surface of what `contains` tells about may lie from the mesh [m]
};

/// As FCL tells for a shape of its own; round ones are triangulated within 0.1 % of their radius.
template <typename FclShape>
Solid solidOf(const TriangleMesh& mesh, const FclShape& shape, double off) {
  const auto contains = [shape](const Eigen::Vector3d& point) {
    const fcl::Sphered probe(kPointRadius);
    fcl::CollisionResultd result;
    return fcl::collide(&shape, fcl::Transform3d::Identity(), &probe,
                        fcl::Transform3d(Eigen::Translation3d(point)), fcl::CollisionRequestd(), result) > 0;
  };
  return {mesh, contains, off};
}

/// The hull of points on a sphere.
TriangleMesh randomHull(std::mt19937& generator, int count) {
  TriangleMesh loose;
  for (int i = 0; i < count; ++i) {
    loose.vertices.push_back(0.3 * randomPose(generator).linear().col(0));
    loose.triangles.push_back({i, i, i});
  }
  return enclosingMesh(loose, LinkShape::convex_hull);
}

Solid randomConvexSolid(std::mt19937& generator) {
  const TriangleMesh hull = randomHull(generator, 30);
  auto faces = std::make_shared<std::vector<int>>();
  for (const auto& triangle : hull.triangles) {
    faces->push_back(3);
    faces->insert(faces->end(), triangle.begin(), triangle.end());
  }
  const fcl::Convexd convex(std::make_shared<std::vector<Eigen::Vector3d>>(hull.vertices),
                            static_cast<int>(hull.triangles.size()), faces);
  // FCL's iterations end within 1e-6.
  return solidOf(hull, convex, 1e-5);
}

/// A star with dents and spikes, of which FCL knows no shape.
Solid randomStar(std::mt19937& generator) {
  TriangleMesh star = randomHull(generator, 40);
  for (Eigen::Vector3d& vertex : star.vertices) vertex *= between(generator, 0.3, 1.0);
  return {star, [star](const Eigen::Vector3d& point) { return windingNumber(star, point) > 0.5; }, 0.0};
}

Solid randomSolid(std::mt19937& generator, int kind) {
  const double radius = between(generator, 0.1, 0.3);
  const double length = between(generator, 0.2, 0.5);
  const Eigen::Vector3d size = randomVector(generator, 0.2, 0.5);
  switch (kind) {
    case 0:
      return solidOf(triangulate(Box{size}), fcl::Boxd(size), 0.0);
    case 1:
      return solidOf(triangulate(Cylinder{radius, length}), fcl::Cylinderd(radius, length), 0.001 * radius);
    case 2:
      return solidOf(triangulate(Sphere{radius}), fcl::Sphered(radius), 0.001 * radius);
    case 3:
      return randomConvexSolid(generator);
    default:
      return randomStar(generator);
  }
}

/// Turned, stretched along axes that are none of its own, and moved.
Solid distorted(std::mt19937& generator, const Solid& solid) {
  const Eigen::Vector3d stretch = randomVector(generator, 0.5, 1.5);
  const Eigen::Affine3d there =
      randomPose(generator) * Eigen::Scaling(stretch) * Eigen::Affine3d(randomPose(generator).linear());
  const Eigen::Affine3d back = there.inverse();
  TriangleMesh mesh = solid.mesh;
  for (Eigen::Vector3d& vertex : mesh.vertices) vertex = there * vertex;
  return {mesh, [solid, back](const Eigen::Vector3d& point) { return solid.contains(back * point); },
          stretch.maxCoeff() * solid.off};
}

class FclDistances : public ::testing::TestWithParam<int> {};

TEST_P(FclDistances, areThoseOfTheField) {
  std::mt19937 generator = seededGenerator();
  const Solid straight = randomSolid(generator, GetParam());
  for (const Solid& solid : {straight, distorted(generator, straight), distorted(generator, straight)}) {
    const double spacing = between(generator, 0.02, 0.04);
    const DistanceField field = computeDistanceField(solid.mesh, spacing);
    const FclMesh exact(solid.mesh);
    const double share = std::min(1.0, 3000.0 / static_cast<double>(field.distance.size()));
    int near = 0;
    int inside = 0;
    int outside = 0;
    forEachSample(field, [&](const Eigen::Vector3d& point, double found) {
      if (between(generator, 0.0, 1.0) > share) return;
      const double distance = exact.distance(point);
      // A sample is the float nearest to a double, which is off by no more than a float of its size can be;
      // a thousandth more than that is far above what doubles of lengths below 10 m lose before.
      const double tolerance = 1.001 * std::ldexp(distance, -24) + kPointRadius;
      if (distance <= kExactReach * spacing) {
        ++near;
        // Nearer than this to its surface the inside is moved that far in.
        if (distance > 1e-6 * spacing) {
          EXPECT_NEAR(std::abs(found), distance, tolerance) << "at " << point.transpose();
        }
      } else {
        EXPECT_LE(std::abs(found), distance + tolerance);
        EXPECT_GE(std::abs(found), kExactReach * spacing - tolerance);
      }
      if (distance <= solid.off + 1e-6 * spacing) return;
      const bool contained = solid.contains(point);
      EXPECT_EQ(found < 0.0, contained) << "at " << point.transpose() << ", " << found;
      ++(contained ? inside : outside);
    });
    EXPECT_GT(near, 100);
    EXPECT_GT(inside, 10);
    EXPECT_GT(outside, 100);
  }
}

INSTANTIATE_TEST_SUITE_P(ofBoxCylinderSphereHullAndStar, FclDistances, ::testing::Range(0, 5));

/// Of several parts some are inside out, as where a modeller mirrored them; none overlap.
TEST(DistanceField, partsThatAreInsideOutStayPartsOfTheSolid) {
  std::mt19937 generator = seededGenerator();
  std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> parts;  // middle and size
  TriangleMesh mesh;
  for (int i = 0; i < 4; ++i) {
    parts.push_back({{0.6 * i, 0.0, 0.0}, randomVector(generator, 0.2, 0.5)});
    TriangleMesh part = triangulate(Box{parts.back().second});
    if (i % 2 == 1) {
      for (auto& triangle : part.triangles) std::swap(triangle[0], triangle[1]);
    }
    mesh.append(part, Eigen::Isometry3d(Eigen::Translation3d(parts.back().first)));
  }
  expectPromise(
      computeDistanceField(mesh, 0.03),
      [&](const Eigen::Vector3d& point) {
        double nearest = std::numeric_limits<double>::infinity();
        for (const auto& [middle, size] : parts)
          nearest = std::min(nearest, boxDistance(size, point - middle));
        return nearest;
      },
      0.0);
}

/// A tenth of the triangles faces the wrong way: that dents and bumps the surface, but hollows nothing out.
TEST(DistanceField, aFewFlippedFacesLeaveTheMiddleInside) {
  std::mt19937 generator = seededGenerator();
  const double radius = 0.3;
  TriangleMesh mesh = triangulate(Sphere{radius});
  for (auto& triangle : mesh.triangles) {
    if (between(generator, 0.0, 1.0) < 0.1) std::swap(triangle[0], triangle[1]);
  }
  forEachSample(computeDistanceField(mesh, 0.08), [&](const Eigen::Vector3d& point, double found) {
    const double winding = std::abs(windingNumber(mesh, point));
    const bool inside = found < 0.0;
    if (std::abs(winding - 0.5) > kSeriesError && std::abs(found) > kRounding) {
      EXPECT_EQ(inside, winding > 0.5) << "at " << point.transpose() << ", winding number " << winding;
    }
    // There the flipped faces are seen under about a tenth of the whole, and count once for each side.
    if (point.norm() < 0.5 * radius) {
      EXPECT_TRUE(inside) << "at " << point.transpose();
    }
  });
}

TEST(DistanceField, movesWithItsMesh) {
  std::mt19937 generator = seededGenerator();
  for (int repeat = 0; repeat < 3; ++repeat) {
    const Eigen::Vector3d size = randomVector(generator, 0.2, 0.6);
    const Eigen::Isometry3d pose = randomPose(generator);
    TriangleMesh moved;
    moved.append(triangulate(Box{size}), pose);
    const DistanceField field = computeDistanceField(moved, 0.04);
    expectPromise(
        field, [&](const Eigen::Vector3d& point) { return boxDistance(size, pose.inverse() * point); }, 0.0);
  }
}

TEST(DistanceField, overlappingBoxesAreTheirUnion) {
  std::mt19937 generator = seededGenerator();
  const Eigen::Vector3d size = randomVector(generator, 0.3, 0.5);
  const Eigen::Isometry3d pose =
      Eigen::Translation3d(size / 3.0) * Eigen::Quaterniond(randomPose(generator).linear());
  TriangleMesh both = triangulate(Box{size});
  both.append(triangulate(Box{size}), pose);
  int inside_both = 0;
  forEachSample(computeDistanceField(both, 0.02), [&](const Eigen::Vector3d& point, double found) {
    const double first = boxDistance(size, point);
    const double second = boxDistance(size, pose.inverse() * point);
    inside_both += first < -kRounding && second < -kRounding ? 1 : 0;
    if (std::min(std::abs(first), std::abs(second)) < kRounding) return;
    EXPECT_EQ(found < 0.0, first < 0.0 || second < 0.0) << "at " << point.transpose();
  });
  EXPECT_GT(inside_both, 0);
}

TEST(DistanceField, signIsThatOfTheWindingNumberWhereAFaceIsMissing) {
  std::mt19937 generator = seededGenerator();
  const Eigen::Vector3d size = randomVector(generator, 0.3, 0.5);
  TriangleMesh open = triangulate(Box{size});
  const auto on_top = [&](const std::array<int, 3>& triangle) {
    const auto points = corners(open, triangle);
    return std::all_of(points.begin(), points.end(),
                       [](const Eigen::Vector3d& point) { return point.z() > 0.0; });
  };
  open.triangles.erase(std::remove_if(open.triangles.begin(), open.triangles.end(), on_top),
                       open.triangles.end());
  ASSERT_EQ(open.triangles.size(), 10u);
  forEachSample(computeDistanceField(open, 0.02), [&](const Eigen::Vector3d& point, double found) {
    if (std::abs(found) < kRounding) return;
    const bool inside = found < 0.0;
    const double winding = windingNumber(open, point);
    // As just above the middle of the missing face.
    if (std::abs(winding - 0.5) < kSeriesError) return;
    EXPECT_EQ(inside, winding > 0.5) << "at " << point.transpose() << ", winding number " << winding;
    // What common sense says: the lower half of the box is inside; beside, below and above it is outside.
    const double distance = boxDistance(size, point);
    if (distance < 0.0 && point.z() < 0.0) {
      EXPECT_TRUE(inside) << "at " << point.transpose();
    }
    if (distance > 0.0) {
      EXPECT_FALSE(inside) << "at " << point.transpose();
    }
  });
}

/// Many small open edges at once: where neither distance nor winding number has a closed form.
TEST(DistanceField, looseTrianglesKeepThePromise) {
  std::mt19937 generator = seededGenerator();
  TriangleMesh loose = triangulate(Sphere{0.2});
  const auto lost = [&](const std::array<int, 3>&) { return between(generator, 0.0, 1.0) < 0.9; };
  loose.triangles.erase(std::remove_if(loose.triangles.begin(), loose.triangles.end(), lost),
                        loose.triangles.end());
  TriangleMesh closed = triangulate(Box{randomVector(generator, 0.1, 0.2)});
  loose.append(closed, randomPose(generator));
  const double spacing = 0.1;
  forEachSample(computeDistanceField(loose, spacing), [&](const Eigen::Vector3d& point, double found) {
    const double distance = meshDistance(loose, point);
    EXPECT_LE(std::abs(found), distance + kRounding);
    EXPECT_GE(std::abs(found), std::min(distance, kExactReach * spacing) - kRounding);
    const double winding = windingNumber(loose, point);
    if (distance > kRounding && std::abs(winding - 0.5) > kSeriesError) {
      const bool inside = found < 0.0;
      EXPECT_EQ(inside, winding > 0.5) << "at " << point.transpose() << ", winding number " << winding;
    }
  });
}

TEST(DistanceField, changesNoFasterThanThePositionNearTheSurface) {
  std::mt19937 generator = seededGenerator();
  TriangleMesh both = triangulate(Box{randomVector(generator, 0.2, 0.4)});
  both.append(triangulate(Cylinder{0.1, 0.5}), randomPose(generator));
  const DistanceField field = computeDistanceField(both, 0.03);
  const std::array<std::ptrdiff_t, 3> stride{
      1, field.samples[0], static_cast<std::ptrdiff_t>(field.samples[0]) * field.samples[1]};
  const double reach = (kExactReach - 1.0) * field.spacing;  // then the neighbour's distance is exact, too
  for (int k = 1; k < field.samples[2]; ++k) {
    for (int j = 1; j < field.samples[1]; ++j) {
      for (int i = 1; i < field.samples[0]; ++i) {
        const float* here = field.distance.data() + i * stride[0] + j * stride[1] + k * stride[2];
        if (std::abs(*here) > reach) continue;
        for (const std::ptrdiff_t step : stride) {
          EXPECT_LE(std::abs(std::abs(*here) - std::abs(*(here - step))), field.spacing + 2.0 * kRounding);
        }
      }
    }
  }
}

TEST(DistanceField, interpolatesWithinTheBoundOfALipschitzFunction) {
  std::mt19937 generator = seededGenerator();
  const Eigen::Vector3d size = randomVector(generator, 0.2, 0.5);
  const DistanceField field = computeDistanceField(triangulate(Box{size}), 0.02);
  const DistanceFieldView view = field.view(field.distance.data());
  int near = 0;
  for (int i = 0; i < 100000; ++i) {
    const Eigen::Vector3d point = size.cwiseProduct(randomVector(generator, -0.6, 0.6));
    const double exact = boxDistance(size, point);
    // All eight corners are exact when the point lies nearer to the surface than 2 spacings less a cell's
    // diagonal.
    if (std::abs(exact) > (kExactReach - std::sqrt(3.0)) * field.spacing) continue;
    ++near;
    const Eigen::Vector3f p = point.cast<float>();
    // Weights w and distances r of the corners: |Σ w·(d(corner) − d)| ≤ Σ w·r ≤ √(Σ w·r²) ≤ √(3/4)·spacing.
    EXPECT_NEAR(view.sample({p.x(), p.y(), p.z()}), exact, std::sqrt(0.75) * field.spacing + 1e-5);
  }
  EXPECT_GT(near, 100);
}

/// Along the normal of a flat face the distance is linear, and interpolation exact.
TEST(DistanceField, isExactBetweenSamplesOverAFlatFace) {
  std::mt19937 generator = seededGenerator();
  const DistanceField field = computeDistanceField(triangulate(Box{{1.0, 1.0, 1.0}}), 0.05);
  const DistanceFieldView view = field.view(field.distance.data());
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3f p(static_cast<float>(between(generator, -0.3, 0.3)),
                            static_cast<float>(between(generator, -0.3, 0.3)),
                            static_cast<float>(between(generator, 0.45, 0.55)));
    // Twenty operations on floats below 1, of which one divides by the spacing.
    EXPECT_NEAR(view.sample({p.x(), p.y(), p.z()}), p.z() - 0.5f, 20.0 * 6e-8);
  }
}

TEST(DistanceField, isOutsideBeyondItsSamples) {
  const DistanceField field = computeDistanceField(triangulate(Box{{1.0, 1.0, 1.0}}), 0.1);
  const DistanceFieldView view = field.view(field.distance.data());
  EXPECT_EQ(view.sample({10.0f, 0.0f, 0.0f}), view.spacing);
  EXPECT_EQ(view.sample({0.0f, -10.0f, 0.0f}), view.spacing);
  EXPECT_LT(view.sample({0.0f, 0.0f, 0.0f}), 0.0f);
}

TEST(DistanceField, hasItsMarginOnEverySide) {
  std::mt19937 generator = seededGenerator();
  for (int repeat = 0; repeat < 10; ++repeat) {
    const Eigen::Vector3d size = randomVector(generator, 0.01, 0.3);
    const DistanceField field = computeDistanceField(triangulate(Box{size}), 0.03);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double low = field.origin[static_cast<int>(axis)];
      const double high = low + field.spacing * (field.samples[axis] - 1);
      const double margin = 2.0 * field.spacing - 1e-12;
      EXPECT_LE(low, -size[static_cast<int>(axis)] / 2.0 - margin);
      EXPECT_GE(high, size[static_cast<int>(axis)] / 2.0 + margin);
      EXPECT_EQ(field.samples[axis] % 2, 1);
    }
  }
}

TEST(DistanceField, aPlateThinnerThanTheSpacingIsNotLost) {
  const DistanceField field = computeDistanceField(triangulate(Box{{0.2, 0.3, 0.001}}), 0.02);
  const DistanceFieldView view = field.view(field.distance.data());
  EXPECT_NEAR(view.sample({0.0f, 0.0f, 0.0f}), -0.0005, kRounding);
}

TEST(DistanceField, trianglesWithoutAreaChangeNothing) {
  const TriangleMesh box = triangulate(Box{{0.2, 0.2, 0.2}});
  TriangleMesh with_slivers = box;
  with_slivers.triangles.push_back({0, 0, 0});
  with_slivers.triangles.push_back({0, 6, 6});
  with_slivers.triangles.push_back({0, 6, 0});
  EXPECT_EQ(computeDistanceField(with_slivers, 0.03).distance, computeDistanceField(box, 0.03).distance);
}

std::string keyOfError(const TriangleMesh& mesh, double spacing) {
  try {
    computeDistanceField(mesh, spacing);
  } catch (const InvalidParameter& error) {
    const std::string message = error.what();
    return message.substr(0, message.find(':'));
  }
  return "no error";
}

TEST(DistanceField, refusesWhatItCannotSample) {
  const TriangleMesh box = triangulate(Box{{1.0, 1.0, 1.0}});
  for (const double spacing :
       {0.0, -0.1, std::nan(""), std::numeric_limits<double>::infinity(), 1e-3, 1e-300}) {
    EXPECT_EQ(keyOfError(box, spacing), "spacing") << spacing;
  }
  EXPECT_EQ(keyOfError(TriangleMesh{}, 0.1), "mesh");
  TriangleMesh wrong = box;
  wrong.vertices[3].z() = std::nan("");
  EXPECT_EQ(keyOfError(wrong, 0.1), "mesh");
  wrong.vertices[3].z() = 1.1e6;
  EXPECT_EQ(keyOfError(wrong, 1e6), "mesh");
  wrong = box;
  wrong.triangles[2][1] = 8;
  EXPECT_EQ(keyOfError(wrong, 0.1), "mesh");
  wrong.triangles[2][1] = -1;
  EXPECT_EQ(keyOfError(wrong, 0.1), "mesh");
  wrong.triangles = {{0, 0, 1}};
  EXPECT_EQ(keyOfError(wrong, 0.1), "mesh");
}

}  // namespace
}  // namespace shallow_sand
