#include <gtest/gtest.h>

#include "coupling/bodies_in_sand.h"
#include "mirrored_field.h"

namespace shallow_sand {
namespace {

// Binary fractions: mirrored columns are rounded alike.
constexpr double kSpacing = 1.0 / 64.0;
constexpr int kRows = 79;
constexpr double kLength = 154 * kSpacing;  ///< of the map along x [m]
constexpr double kSurface = 0.3;
constexpr double kRadius = 0.2;
constexpr double kWidth = 15 * kSpacing;  ///< its sides lie between columns
constexpr double kSunk = 0.06;
constexpr double kSpeed = 0.25;
constexpr double kTravel = 1.0;
constexpr double kStartX = 0.6;
constexpr double kMiddleY = 0.5 * kRows * kSpacing;  ///< on the middle of a row
constexpr double kDuration = kTravel / kSpeed;

/// A wheel whose axle lies along y.
TriangleMesh wheelMesh() {
  TriangleMesh mesh;
  mesh.append(triangulate(Cylinder{kRadius, kWidth}),
              Eigen::Isometry3d(turned(0.5 * M_PI, Eigen::Vector3d::UnitX())));
  return mesh;
}

/// A wheel that travels along x while its rim turns as many times as fast.
Simulator wheelSimulator(double rim_over_travel, double travel) {
  const Scene scene = levelSand({kLength, kRows * kSpacing}, kSpacing, kSurface);
  const Eigen::Vector3d from(kStartX, kMiddleY, kSurface - kSunk + kRadius);
  Simulator simulator = buildSimulator(scene);
  const TriangleMesh mesh = wheelMesh();
  const std::size_t wheel =
      simulator.addBody("wheel", std::make_shared<const DistanceField>(mirroredField(
                                     computeDistanceField(mesh, distanceSpacing(mesh, kSpacing)), 1)));
  const std::vector<PoseKey> motion =
      spinningMotion(from, from + Eigen::Vector3d(travel, 0.0, 0.0), kDuration, Eigen::Vector3d::UnitY(),
                     rim_over_travel * kSpeed / kRadius);
  for (const PoseKey& key : motion) simulator.appendPose(wheel, key.time, key.pose);
  return simulator;
}

struct Rut {
  double shallowest;  ///< on the middle line, under the wheel's way [m]
  double deepest;
  double asymmetry;     ///< largest difference between mirrored columns [m]
  double moved;         ///< how far forward sand was moved, times its volume [m⁴]
  double most_overlap;  ///< [m³]
  double error;
};

double asymmetry(const Grid& grid, const Fields& fields) {
  double largest = 0.0;
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      largest = std::max<double>(largest, std::abs(fields.surface(grid.index(i, j)) -
                                                   fields.surface(grid.index(i, grid.rows - 1 - j))));
    }
  }
  return largest;
}

Rut rutOf(double rim_over_travel) {
  Simulator simulator = wheelSimulator(rim_over_travel, kTravel);
  Rut rut{kSurface, 0.0, 0.0, 0.0, 0.0, 0.0};
  rut.most_overlap = runWatchingOverlap(simulator, kDuration);
  const Grid& grid = simulator.grid();
  const Fields fields = simulator.fields();
  for (double x = kStartX; x < kStartX + kTravel - kRadius; x += kSpacing) {
    const double depth = kSurface - surfaceAt(grid, fields, {x, kMiddleY});
    rut.shallowest = std::min(rut.shallowest, depth);
    rut.deepest = std::max(rut.deepest, depth);
  }
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      const double rise = fields.allDepth(grid.index(i, j)) - kSurface;
      rut.moved += rise * grid.x(i) * grid.cellArea();
    }
  }
  rut.asymmetry = asymmetry(grid, fields);
  rut.error = simulator.ledger().error();
  std::printf(
      "rim %.1f times as fast as the wheel: rut %.4f to %.4f m, moved by %.2e m^4, asymmetry %.1e m, "
      "overlap at most %.1e m^3, volume error %.0e\n",
      rim_over_travel, rut.shallowest, rut.deepest, rut.moved, rut.asymmetry, rut.most_overlap, rut.error);
  return rut;
}

/// Of the wheel, below the old surface. [m³]
double submerged() {
  const double angle = std::acos((kRadius - kSunk) / kRadius);
  return kWidth * kRadius * kRadius * (angle - std::sin(angle) * std::cos(angle));
}

TEST(Wheel, RollsARutAsDeepAsItSinks) {
  const Rut rut = rutOf(1.0);
  EXPECT_NEAR(rut.shallowest, kSunk, 0.05 * kSunk);
  EXPECT_NEAR(rut.deepest, kSunk, 0.05 * kSunk);
  EXPECT_LT(rut.asymmetry, 0.01 * kSunk);
  EXPECT_LT(rut.most_overlap, 0.05 * submerged());
  EXPECT_LT(rut.error, 1e-6);
}

TEST(Wheel, ThrowsSandBackWhereItSlips) {
  const Rut rolling = rutOf(1.0);
  const Rut slipping = rutOf(4.0);
  // How deep the wheel sits is prescribed: only what its rim takes along can lie deeper than its lowest
  // point.
  EXPECT_GT(slipping.deepest, rolling.deepest - 1e-3 * kSunk);
  EXPECT_LT(slipping.moved, rolling.moved - 0.1 * std::abs(rolling.moved));
  EXPECT_LT(slipping.asymmetry, 0.05 * kSunk);
  EXPECT_LT(slipping.most_overlap, 0.05 * submerged());
  EXPECT_LT(slipping.error, 1e-6);
}

/// On the spot, with the top of the wheel going forward.
TEST(Wheel, ThrowsSandBackWhereItOnlySpins) {
  Simulator simulator = wheelSimulator(4.0, 0.0);
  const Fields before = simulator.fields();
  const double most_overlap = runWatchingOverlap(simulator, kDuration);
  const Grid& grid = simulator.grid();
  const Fields fields = simulator.fields();
  const auto gained = [&](auto&& chosen) {
    return volumeWhere(grid, fields, chosen) - volumeWhere(grid, before, chosen);
  };
  const double behind = gained([](double x, double) { return x < kStartX; });
  const double ahead = gained([](double x, double) { return x > kStartX; });
  std::printf(
      "sand behind the axle %.2e m^3 more than before, ahead %.2e; overlap at most %.1e of %.1e m^3\n",
      behind, ahead, most_overlap, submerged());
  // Thrown is what has to make way at first; later a wheel without treads drags nothing, as the README tells.
  EXPECT_GT(behind - ahead, 0.05 * submerged());
  EXPECT_LT(most_overlap, 0.05 * submerged());
  EXPECT_LT(asymmetry(grid, fields), 0.05 * kSunk);
  EXPECT_LT(simulator.ledger().error(), 1e-6);
}

}  // namespace
}  // namespace shallow_sand
