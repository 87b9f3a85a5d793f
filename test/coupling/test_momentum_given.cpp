#include <gtest/gtest.h>

#include "coupling/bodies_in_sand.h"
#include "random_fields.h"
#include "random_seed.h"

namespace shallow_sand {
namespace {

constexpr double kSpacing = 0.02;
constexpr double kSurface = 0.3;
constexpr double kBottom = 0.18;  ///< of the body, in the sand from the start
/// Two columns thick: all of its sand goes out at once.
const Eigen::Vector3d kBox{2.0 * kSpacing, 0.32, 0.4};
const Eigen::Vector2d kMiddle{0.6, 0.6};

/// The last pose of a body that came with a given velocity, in sand that rests: what is inside the body is
/// sent out of it once.
Simulator struckSand(const Eigen::Vector3d& velocity, const Eigen::Vector3d& angular,
                     const Eigen::Vector3d& arm) {
  const Scene scene = levelSand({1.2, 1.2}, kSpacing, kSurface);
  Simulator simulator = buildSimulator(scene);
  TriangleMesh mesh;
  mesh.append(triangulate(Box{kBox}), Eigen::Isometry3d(Eigen::Translation3d(arm)));
  const std::size_t body =
      simulator.addBody("box", std::make_shared<const DistanceField>(computeDistanceField(
                                   mesh, distanceSpacing(mesh, scene.parameters.grid.spacing))));
  const Eigen::Vector3d place = Eigen::Vector3d(kMiddle.x(), kMiddle.y(), kBottom + 0.5 * kBox.z()) - arm;
  const double before = 0.1;
  const double angle = angular.norm() * before;
  const Eigen::Vector3d axis = angle > 0.0 ? Eigen::Vector3d(angular.normalized()) : Eigen::Vector3d::UnitZ();
  simulator.appendPose(body, -before, poseKey(0.0, place - before * velocity, turned(-angle, axis)).pose);
  simulator.appendPose(body, 0.0, poseKey(0.0, place).pose);
  simulator.advance(0.0);
  return simulator;
}

Eigen::Vector2d totalMomentum(const Grid& grid, const Fields& fields) {
  Eigen::Vector2d sum(0.0, 0.0);
  for (std::size_t k = 0; k < grid.cells(); ++k)
    sum += Eigen::Vector2d(fields.momentum_x[k], fields.momentum_y[k]);
  return sum * grid.cellArea();
}

/// Eq. 20 and 26, summed over all columns: the part of the sand inside the body moves with it, and the rest
/// stays at rest.
Eigen::Vector2d momentumByHand(const Eigen::Vector3d& velocity, const Eigen::Vector3d& angular,
                               const Eigen::Vector3d& arm) {
  const double submerged = kSurface - kBottom;
  const Eigen::Vector3d middle = arm + Eigen::Vector3d(0.0, 0.0, 0.5 * (submerged - kBox.z()));
  const Eigen::Vector3d mean = velocity + angular.cross(middle);
  return kBox.x() * kBox.y() * submerged * mean.head<2>();
}

TEST(MomentumGiven, IsThatOfTheSandInsideWhenTheBodyTranslates) {
  std::mt19937 random = seededGenerator();
  for (int trial = 0; trial < 8; ++trial) {
    const Eigen::Vector3d velocity(uniform(random, -2.0, 2.0), uniform(random, -2.0, 2.0), 0.0);
    const Eigen::Vector3d none(0.0, 0.0, 0.0);
    const Simulator simulator = struckSand(velocity, none, none);
    const Eigen::Vector2d given = totalMomentum(simulator.grid(), simulator.fields());
    const Eigen::Vector2d expected = momentumByHand(velocity, none, none);
    EXPECT_LT((given - expected).norm(), 1e-3 * expected.norm()) << velocity.transpose();
  }
}

TEST(MomentumGiven, IsThatOfTheSandInsideWhenTheBodySwingsAboutAnUprightAxis) {
  std::mt19937 random = seededGenerator();
  for (int trial = 0; trial < 8; ++trial) {
    const Eigen::Vector3d velocity(uniform(random, -1.0, 1.0), uniform(random, -1.0, 1.0), 0.0);
    const Eigen::Vector3d angular(0.0, 0.0, uniform(random, -3.0, 3.0));
    const Eigen::Vector3d arm(uniform(random, -0.5, 0.5), uniform(random, -0.5, 0.5), 0.0);
    const Simulator simulator = struckSand(velocity, angular, arm);
    const Eigen::Vector2d given = totalMomentum(simulator.grid(), simulator.fields());
    const Eigen::Vector2d expected = momentumByHand(velocity, angular, arm);
    const double scale =
        kBox.x() * kBox.y() * (kSurface - kBottom) * (velocity.norm() + angular.norm() * arm.norm());
    EXPECT_LT((given - expected).norm(), 1e-3 * scale) << velocity.transpose() << ", " << angular.z();
  }
}

/// A body that spins about its own middle gives no momentum, but a twist: ω times the polar moment of the
/// sand inside. That sand is one column farther on when it is looked at.
TEST(MomentumGiven, TurnsTheSandWhenTheBodySpins) {
  const Eigen::Vector3d none(0.0, 0.0, 0.0);
  const double rate = 2.0;
  const Simulator simulator = struckSand(none, {0.0, 0.0, rate}, none);
  const Grid& grid = simulator.grid();
  const Fields fields = simulator.fields();
  double given = 0.0;
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      const std::size_t k = grid.index(i, j);
      given += (grid.x(i) - kMiddle.x()) * static_cast<double>(fields.momentum_y[k]) -
               (grid.y(j) - kMiddle.y()) * static_cast<double>(fields.momentum_x[k]);
    }
  }
  given *= grid.cellArea();
  const double inside = kBox.x() * kBox.y() * (kSurface - kBottom);
  const double expected = rate * inside * (kBox.x() * kBox.x() + kBox.y() * kBox.y()) / 12.0;
  const double farthest = 0.5 * kBox.head<2>().norm();
  EXPECT_NEAR(given, expected, rate * inside * kSpacing * farthest);
  EXPECT_LT(totalMomentum(grid, fields).norm(), 1e-4 * rate * inside * farthest);
  std::printf("twist given %.3e m^5/s, by hand %.3e\n", given, expected);
}

/// Eq. 23 and 24: beside a body that moves down, sand is pushed away from it by half a cell's length of
/// vertical motion; of the mean over the column, for only a part of it is inside the body.
TEST(MomentumGiven, GoesSidewaysWhenTheBodyMovesDown) {
  const double speed = 0.3;
  const Eigen::Vector3d none(0.0, 0.0, 0.0);
  const Simulator simulator = struckSand({0.0, 0.0, -speed}, none, none);
  const Grid& grid = simulator.grid();
  const Fields fields = simulator.fields();
  const double expected = 0.5 * kSpacing * speed * (kSurface - kBottom) / kSurface;
  const auto column = [&](double position) { return static_cast<int>(position / kSpacing); };
  const int middle_row = column(kMiddle.y());
  const int middle_column = column(kMiddle.x());
  const int right = column(kMiddle.x() + 0.5 * kBox.x() + 0.5 * kSpacing);
  const int left = column(kMiddle.x() - 0.5 * kBox.x() - 0.5 * kSpacing);
  const int above = column(kMiddle.y() + 0.5 * kBox.y() + 0.5 * kSpacing);
  const int below = column(kMiddle.y() - 0.5 * kBox.y() - 0.5 * kSpacing);
  EXPECT_NEAR(fields.momentum_x[grid.index(right, middle_row)], expected, 1e-3 * expected);
  EXPECT_NEAR(fields.momentum_x[grid.index(left, middle_row)], -expected, 1e-3 * expected);
  EXPECT_NEAR(fields.momentum_y[grid.index(middle_column, above)], expected, 1e-3 * expected);
  EXPECT_NEAR(fields.momentum_y[grid.index(middle_column, below)], -expected, 1e-3 * expected);
}

/// What the rays say of a body's velocity, in every column, against V + ω × r.
TEST(MomentumGiven, ContactVelocityIsThatOfTheBodyInTheMiddleOfTheInterval) {
  std::mt19937 random = seededGenerator();
  const auto vector = [&](double most) {
    const double x = uniform(random, -most, most);
    const double y = uniform(random, -most, most);
    return Eigen::Vector3d(x, y, uniform(random, -most, most));
  };
  for (int trial = 0; trial < 8; ++trial) {
    const Eigen::Vector3d velocity = vector(1.0);
    const Eigen::Vector3d angular = vector(3.0);
    const Eigen::Vector3d arm = vector(0.3);
    const Simulator simulator = struckSand(velocity, angular, arm);
    const Grid& grid = simulator.grid();
    const ContactSnapshot contacts = simulator.snapshot().contacts;
    const Eigen::Vector3d origin = Eigen::Vector3d(kMiddle.x(), kMiddle.y(), kBottom + 0.5 * kBox.z()) - arm;
    int met = 0;
    for (int j = 0; j < grid.rows; ++j) {
      for (int i = 0; i < grid.columns; ++i) {
        const std::size_t k = grid.index(i, j);
        if (!(contacts.length[k] > 0.0f)) continue;
        const double z = static_cast<double>(contacts.clearance[k]) + 0.5 * contacts.length[k];
        const Eigen::Vector3d expected =
            velocity + angular.cross(Eigen::Vector3d(grid.x(i), grid.y(j), z) - origin);
        ASSERT_NEAR(contacts.velocity_x[k], expected.x(), 1e-4) << i << ", " << j;
        ASSERT_NEAR(contacts.velocity_y[k], expected.y(), 1e-4) << i << ", " << j;
        ASSERT_NEAR(contacts.clearance[k], kBottom, 1e-4) << i << ", " << j;
        ASSERT_NEAR(contacts.length[k], kSurface - kBottom, 1e-4) << i << ", " << j;
        met += 1;
      }
    }
    EXPECT_EQ(met, 2 * 16);
  }
}

}  // namespace
}  // namespace shallow_sand
