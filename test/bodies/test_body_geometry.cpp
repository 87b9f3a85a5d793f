#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "random_seed.h"
#include "shallow_sand/bodies/body_geometry.h"
#include "shallow_sand/core/parameters.h"
#include "temporary_folder.h"

namespace shallow_sand {
namespace {

namespace fs = std::filesystem;

constexpr double kCell = 0.05;

double between(std::mt19937& generator, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(generator);
}

float at(const DistanceField& field, double x, double y, double z) {
  return field.view(field.distance.data())
      .sample({static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)});
}

/// How far the solid reaches along `direction` from a point in it, to a thousandth of a cell; found by steps,
/// so that gaps count. [m]
double reach(const DistanceField& field, const Eigen::Vector3d& from, const Eigen::Vector3d& direction) {
  const double step = 1e-3 * kCell;
  double length = 0.0;
  for (;;) {
    const Eigen::Vector3d point = from + length * direction;
    if (!(at(field, point.x(), point.y(), point.z()) < 0.0f)) return length;
    length += step;
  }
}

/// Rounding of floats and the step of `reach`.
constexpr double kTolerance = 1.5e-3 * kCell;

TEST(BodyGeometry, aThickBoxKeepsItsExactSize) {
  std::mt19937 generator = seededGenerator();
  for (int repeat = 0; repeat < 5; ++repeat) {
    const Eigen::Vector3d size =
        kCell * Eigen::Vector3d(between(generator, 3.0, 6.0), between(generator, 3.0, 6.0),
                                repeat == 0 ? 3.0 : between(generator, 3.0, 6.0));
    const BodyGeometry geometry = makeBodyGeometry(triangulate(Box{size}), kCell);
    EXPECT_TRUE(geometry.notes.empty()) << geometry.notes.front();
    for (int axis = 0; axis < 3; ++axis) {
      for (const double side : {-1.0, 1.0}) {
        // Off the middle, but farther from edges than samples lie apart.
        Eigen::Vector3d from = 0.25 * size;
        from[axis] = 0.0;
        const double found = reach(*geometry.field, from, side * Eigen::Vector3d::Unit(axis));
        EXPECT_NEAR(found, size[axis] / 2.0, kTolerance) << "axis " << axis;
      }
    }
    // No sample is moved, at edges and corners neither.
    const DistanceField plain = computeDistanceField(triangulate(Box{size}), geometry.field->spacing);
    for (int i = 0; i < 1000; ++i) {
      const Eigen::Vector3d point = size.cwiseProduct(Eigen::Vector3d(
          between(generator, -0.5, 0.5), between(generator, -0.5, 0.5), between(generator, -0.5, 0.5)));
      const Eigen::Array3d beyond = point.array().abs() - size.array() / 2.0;
      if (beyond.maxCoeff() < -0.5 * kCell) continue;
      // Both interpolate a function of slope 1 from samples that differ.
      EXPECT_NEAR(at(*geometry.field, point.x(), point.y(), point.z()), beyond.maxCoeff(),
                  std::sqrt(0.75) * geometry.field->spacing + kTolerance);
    }
  }
}

TEST(BodyGeometry, aThickCylinderKeepsItsRadius) {
  std::mt19937 generator = seededGenerator();
  const Cylinder cylinder{kCell * between(generator, 2.0, 5.0), kCell * between(generator, 3.0, 6.0)};
  const BodyGeometry geometry = makeBodyGeometry(triangulate(cylinder), kCell);
  EXPECT_TRUE(geometry.notes.empty()) << geometry.notes.front();
  for (int i = 0; i < 50; ++i) {
    const double angle = between(generator, -3.2, 3.2);
    const double found =
        reach(*geometry.field, Eigen::Vector3d::Zero(), {std::cos(angle), std::sin(angle), 0.0});
    // Interpolation cuts off a round surface by up to 3·spacing²/(8·radius).
    const double sag = 3.0 * std::pow(geometry.field->spacing, 2) / (8.0 * cylinder.radius);
    EXPECT_NEAR(found, cylinder.radius, sag + 0.001 * cylinder.radius + kTolerance);
  }
  EXPECT_NEAR(reach(*geometry.field, Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ()),
              cylinder.length / 2.0, kTolerance);
}

/// Closed or a single sheet, level or turned: a cell at least, so that no row of columns misses it.
TEST(BodyGeometry, sheetsBecomeAsThickAsACell) {
  std::mt19937 generator = seededGenerator();
  for (int repeat = 0; repeat < 12; ++repeat) {
    const double thickness = kCell * between(generator, 0.02, 0.95);
    TriangleMesh sheet = triangulate(Box{{0.6, 0.5, thickness}});
    if (repeat % 3 == 0) {
      sheet.vertices = {{-0.3, -0.25, 0.0}, {0.3, -0.25, 0.0}, {0.3, 0.25, 0.0}, {-0.3, 0.25, 0.0}};
      sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
    }
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    if (repeat % 2 == 0) {
      std::normal_distribution<double> normal;
      pose.linear() =
          Eigen::Quaterniond(normal(generator), normal(generator), normal(generator), normal(generator))
              .normalized()
              .toRotationMatrix();
    }
    TriangleMesh turned;
    turned.append(sheet, pose);
    const BodyGeometry geometry = makeBodyGeometry(turned, kCell);
    ASSERT_EQ(geometry.notes.empty(), false);
    EXPECT_NE(geometry.notes.front().find("thinner than 0.0578 m"), std::string::npos)
        << geometry.notes.front();
    for (int i = 0; i < 20; ++i) {
      const Eigen::Vector3d from =
          pose * Eigen::Vector3d(between(generator, -0.2, 0.2), between(generator, -0.15, 0.15), 0.0);
      const Eigen::Vector3d normal = pose.linear().col(2);
      const double found = reach(*geometry.field, from, normal) + reach(*geometry.field, from, -normal);
      EXPECT_LE(found, 1.155 * kCell + 2.0 * kTolerance) << "thickness " << thickness << " case " << repeat;
      EXPECT_GE(found, kCell - kTolerance) << "thickness " << thickness << " case " << repeat;
    }
  }
}

/// A plate on a block: the plate grows, the block does not.
TEST(BodyGeometry, onlyThinPartsGrow) {
  TriangleMesh both = triangulate(Box{{4.0 * kCell, 4.0 * kCell, 4.0 * kCell}});
  both.append(triangulate(Box{{10.0 * kCell, 4.0 * kCell, 0.1 * kCell}}),
              Eigen::Isometry3d(Eigen::Translation3d(6.0 * kCell, 0.0, 0.0)));
  const BodyGeometry geometry = makeBodyGeometry(both, kCell);
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  EXPECT_NEAR(reach(*geometry.field, Eigen::Vector3d::Zero(), up), 2.0 * kCell, kTolerance);
  EXPECT_NEAR(reach(*geometry.field, Eigen::Vector3d::Zero(), -Eigen::Vector3d::UnitX()), 2.0 * kCell,
              kTolerance);
  const double half = reach(*geometry.field, {7.0 * kCell, 0.0, 0.0}, up);
  EXPECT_GE(half, 0.5 * kCell - kTolerance);
  EXPECT_LE(half, 0.5 * 1.155 * kCell + kTolerance);
}

TEST(BodyGeometry, brokenMeshesKeepTheirInside) {
  std::mt19937 generator = seededGenerator();
  const Eigen::Vector3d size(0.5, 0.4, 0.3);
  const TriangleMesh box = triangulate(Box{size});
  TriangleMesh doubled = box;
  doubled.append(box, Eigen::Isometry3d::Identity());
  TriangleMesh inside_out = box;
  for (auto& triangle : inside_out.triangles) std::swap(triangle[1], triangle[2]);
  TriangleMesh overlapping = box;
  overlapping.append(triangulate(Box{0.8 * size}), Eigen::Isometry3d(Eigen::Translation3d(0.05 * size)));
  for (const TriangleMesh& mesh : {doubled, inside_out, overlapping}) {
    const BodyGeometry geometry = makeBodyGeometry(mesh, kCell);
    for (int i = 0; i < 500; ++i) {
      const Eigen::Vector3d point = 1.2 * size.cwiseProduct(Eigen::Vector3d(between(generator, -0.5, 0.5),
                                                                            between(generator, -0.5, 0.5),
                                                                            between(generator, -0.5, 0.5)));
      const double distance = (point.array().abs() - size.array() / 2.0).maxCoeff();
      // Farther from the surface than a cell of samples reaches.
      if (std::abs(distance) < std::sqrt(3.0) * geometry.field->spacing) continue;
      EXPECT_EQ(at(*geometry.field, point.x(), point.y(), point.z()) < 0.0f, distance < 0.0)
          << point.transpose();
    }
  }
}

TEST(BodyGeometry, tellsHowFarAMeshCanBeTrusted) {
  TriangleMesh open = triangulate(Box{{1.0, 1.0, 1.0}});
  open.triangles.resize(6);
  const BodyGeometry geometry = makeBodyGeometry(open, 4.0 * kCell);
  const auto doubts = [](const std::string& note) {
    return note.find("edges are open") != std::string::npos;
  };
  EXPECT_TRUE(std::any_of(geometry.notes.begin(), geometry.notes.end(), doubts));
}

TEST(BodyGeometry, largeBodiesAreSampledWithinBounds) {
  const TriangleMesh large = triangulate(Box{{40.0, 30.0, 20.0}});
  const double spacing = distanceSpacing(large, kCell);
  EXPECT_GT(spacing, 0.5 * kCell);
  EXPECT_LE((Eigen::Array3d(40.0, 30.0, 20.0) / spacing).prod(), 1 << 24);
}

TEST(EnclosingMesh, hullOfACubeWithAHoleIsTheCube) {
  TriangleMesh open = triangulate(Box{{1.0, 2.0, 3.0}});
  const Eigen::Isometry3d pose(Eigen::Translation3d(5.0, -7.0, 9.0) *
                               Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, 2.0, 3.0).normalized()));
  TriangleMesh moved;
  moved.append(open, pose);
  moved.triangles.resize(10);
  const TriangleMesh hull = enclosingMesh(moved, LinkShape::convex_hull);
  double volume = 0.0;
  for (const auto& triangle : hull.triangles) {
    const auto vertex = [&](std::size_t i) {
      return Eigen::Vector3d(pose.inverse() * hull.vertices[static_cast<std::size_t>(triangle[i])]);
    };
    volume += vertex(0).dot(vertex(1).cross(vertex(2))) / 6.0;
  }
  EXPECT_NEAR(volume, 6.0, 1e-6);  // qhull works in doubles, and joggles nothing here
}

TEST(EnclosingMesh, boundingBoxHoldsAllVertices) {
  std::mt19937 generator = seededGenerator();
  for (int repeat = 0; repeat < 10; ++repeat) {
    std::normal_distribution<double> normal;
    TriangleMesh mesh;
    const Eigen::Quaterniond turn(normal(generator), normal(generator), normal(generator), normal(generator));
    mesh.append(triangulate(Box{{3.0, 0.5, 0.2}}),
                Eigen::Isometry3d(Eigen::Translation3d(1.0, 2.0, 3.0) * turn.normalized()));
    const TriangleMesh box = enclosingMesh(mesh, LinkShape::bounding_box);
    ASSERT_EQ(box.triangles.size(), 12u);
    const DistanceField field = computeDistanceField(box, 0.1);
    for (const Eigen::Vector3d& vertex : mesh.vertices) {
      // A box that touches its content, and what interpolation makes of a corner.
      EXPECT_LE(at(field, vertex.x(), vertex.y(), vertex.z()), std::sqrt(0.75) * 0.1);
    }
  }
}

TEST(EnclosingMesh, aFlatMeshHasNoHullButABox) {
  TriangleMesh flat;
  flat.vertices = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {1.0, 1.0, 0.0}, {0.0, 1.0, 0.0}};
  flat.triangles = {{0, 1, 2}, {0, 2, 3}};
  EXPECT_THROW(enclosingMesh(flat, LinkShape::convex_hull), InvalidParameter);
  BodyGeometryOptions options;
  options.shape = LinkShape::bounding_box;
  EXPECT_LT(at(*makeBodyGeometry(flat, kCell, options).field, 0.5, 0.5, 0.0), 0.0f);
}

TEST(LinkShapes, areReadByName) {
  EXPECT_EQ(linkShapeFromString("convex_hull", "as"), LinkShape::convex_hull);
  try {
    linkShapeFromString("hull", "as");
    FAIL();
  } catch (const InvalidParameter& error) {
    EXPECT_EQ(std::string(error.what()), "as: hull; expected exact, convex_hull or bounding_box");
  }
}

class FieldCaching : public ::testing::Test {
 protected:
  BodyGeometry make(const TriangleMesh& mesh, double cell) {
    BodyGeometryOptions options;
    options.cache = folder_.path() / "fields";
    return makeBodyGeometry(mesh, cell, options);
  }
  std::vector<fs::path> files() const {
    std::vector<fs::path> found;
    for (const auto& entry : fs::directory_iterator(folder_.path() / "fields")) found.push_back(entry.path());
    return found;
  }
  TemporaryFolder folder_;
  TriangleMesh plate_ = triangulate(Box{{0.4, 0.3, 0.01}});
};

TEST_F(FieldCaching, aHitHasTheSameBitsAndNotes) {
  const BodyGeometry first = make(plate_, kCell);
  const BodyGeometry second = make(plate_, kCell);
  EXPECT_FALSE(first.from_cache);
  EXPECT_TRUE(second.from_cache);
  EXPECT_EQ(first.field->distance, second.field->distance);
  EXPECT_EQ(first.field->samples, second.field->samples);
  EXPECT_EQ(first.field->spacing, second.field->spacing);
  EXPECT_EQ(first.field->origin, second.field->origin);
  EXPECT_EQ(first.notes, second.notes);
  EXPECT_EQ(files().size(), 1u);
}

TEST_F(FieldCaching, otherContentAndOtherCellsDoNotHit) {
  make(plate_, kCell);
  EXPECT_FALSE(make(plate_, 1.01 * kCell).from_cache);
  TriangleMesh other = plate_;
  other.vertices[0].x() = std::nextafter(other.vertices[0].x(), 1.0);
  EXPECT_FALSE(make(other, kCell).from_cache);
  other = plate_;
  std::swap(other.triangles[0], other.triangles[1]);
  EXPECT_FALSE(make(other, kCell).from_cache);
}

TEST_F(FieldCaching, aSpoiltFileIsComputedAnew) {
  std::mt19937 generator = seededGenerator();
  const BodyGeometry first = make(plate_, kCell);
  const fs::path file = files().front();
  std::ifstream input(file, std::ios::binary);
  const std::string whole((std::istreambuf_iterator<char>(input)), std::istreambuf_iterator<char>());
  for (int repeat = 0; repeat < 20; ++repeat) {
    std::string spoilt = whole;
    const std::size_t place = generator() % whole.size();
    if (repeat == 0) {
      spoilt = "not a field";
    } else if (repeat == 1) {
      spoilt.clear();
    } else if (repeat % 2 == 0) {
      spoilt.resize(place);
    } else {
      spoilt[place] = static_cast<char>(spoilt[place] ^ 1);
    }
    std::ofstream(file, std::ios::binary) << spoilt;
    const BodyGeometry again = make(plate_, kCell);
    EXPECT_FALSE(again.from_cache);
    EXPECT_EQ(again.field->distance, first.field->distance);
    EXPECT_TRUE(make(plate_, kCell).from_cache);
  }
}

TEST_F(FieldCaching, aFolderThatCannotBeWrittenIsANoteOnly) {
  std::ofstream(folder_.path() / "fields") << "a file where a folder should be";
  const BodyGeometry geometry = make(plate_, kCell);
  EXPECT_GT(geometry.field->distance.size(), 0u);
  ASSERT_FALSE(geometry.notes.empty());
  EXPECT_NE(geometry.notes.back().find("not kept"), std::string::npos) << geometry.notes.back();
}

}  // namespace
}  // namespace shallow_sand
