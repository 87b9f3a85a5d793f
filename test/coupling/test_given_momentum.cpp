#include <gtest/gtest.h>

#include <cfloat>

#include "coupling/bodies_in_sand.h"
#include "mirrored_field.h"
#include "random_bodies.h"
#include "random_seed.h"
#include "shallow_sand/bodies/motion.h"

namespace shallow_sand {
namespace {

Eigen::Vector2d momentumOf(const Fields& fields, std::size_t k) {
  Eigen::Vector2d momentum(fields.momentum_x[k], fields.momentum_y[k]);
  if (!fields.load.empty()) momentum += Eigen::Vector2d(fields.load_momentum_x[k], fields.load_momentum_y[k]);
  return momentum;
}

Eigen::Vector2d givenBy(const Simulator& simulator, std::size_t body) {
  return simulator.contacts(simulator.fields())[body].given_momentum;
}

Eigen::Vector2d givenByAll(const Simulator& simulator) {
  Eigen::Vector2d sum(0.0, 0.0);
  for (const SandContact& contact : simulator.contacts(simulator.fields())) sum += contact.given_momentum;
  return sum;
}

/// By how much the momentum of all sand differs, and what the roundings of floats may add to that. [m⁴/s]
struct Gain {
  Eigen::Vector2d momentum{0.0, 0.0};
  double roundings = 0.0;
};

/// @param fastest point of a body that moves the sand in between [m/s]
Gain gainBetween(const Grid& grid, const Fields& before, const Fields& after, double fastest) {
  // In a hop, a column's momentum goes through at most 16 operations, and through at most 8 in each of the 8
  // passes in which pushed sand goes down; there are four hops. None rounds by more than half of an epsilon
  // of what the column has, had, or got from bodies.
  constexpr double kOperations = 4 * (16 + 8 * 8);
  Gain gain;
  for (std::size_t k = 0; k < grid.cells(); ++k) {
    const Eigen::Vector2d had = momentumOf(before, k);
    const Eigen::Vector2d has = momentumOf(after, k);
    gain.momentum += grid.cellArea() * (has - had);
    const double most = std::max(before.allDepth(k), after.allDepth(k));
    if (had == has && before.allDepth(k) == after.allDepth(k)) continue;
    gain.roundings += grid.cellArea() * (had.norm() + has.norm() + most * fastest);
  }
  gain.roundings *= kOperations * 0.5 * static_cast<double>(FLT_EPSILON);
  return gain;
}

/// Sand that streams here and there, from the start on.
Simulator streamingSand(std::mt19937& random, const RandomSand& sand) {
  Simulator simulator(sand.parameters, sand.bed, sand.depth);
  Snapshot start = simulator.snapshot();
  Fields& fields = start.fields;
  const float speed = static_cast<float>(std::sqrt(9.81 * sand.parameters.grid.spacing));
  fields.momentum_x = randomWaves(random, simulator.grid());
  fields.momentum_y = randomWaves(random, simulator.grid());
  for (std::size_t k = 0; k < simulator.grid().cells(); ++k) {
    fields.momentum_x[k] *= speed * fields.depth[k];
    fields.momentum_y[k] *= speed * fields.depth[k];
  }
  simulator.restore(start);
  return simulator;
}

/// Bodies come one after the other, into each other's way; the sand may go on and fall on them in between.
/// While sand makes way for the last one, it takes no step.
void expectThatGivenIsGot(bool displacement, int scenes) {
  std::mt19937 random = seededGenerator();
  double most_given = 0.0;
  double largest_error = 0.0;
  for (int scene = 0; scene < scenes; ++scene) {
    SCOPED_TRACE("scene " + std::to_string(scene));
    RandomSand sand = randomSand(random, randomCount(random, 5, 40), randomCount(random, 5, 40));
    sand.parameters.coupling = displacement ? Coupling::displacement : Coupling::drag;
    const double spacing = sand.parameters.grid.spacing;
    const double stop = sand.parameters.grid.size.maxCoeff() / std::sqrt(9.81 * spacing);
    Simulator simulator = streamingSand(random, sand);
    for (int k = 0; k < 4; ++k) {
      RandomBody body = randomBody(random, spacing);
      moveThroughSand(random, sand, stop, body);
      const Fields before = simulator.fields();
      const Eigen::Vector2d given_before = givenByAll(simulator);
      addTo(simulator, body);
      simulator.advance(0.0);
      Motion motion;
      for (const PoseKey& key : body.motion) motion.append(key.time, key.pose);
      const Twist twist = motion.twistAt(simulator.time());
      const double fastest = twist.linear.norm() + twist.angular.norm() * body.radius;
      const Gain gain = gainBetween(simulator.grid(), before, simulator.fields(), fastest);
      const Eigen::Vector2d given = givenByAll(simulator) - given_before;
      EXPECT_LE((given - gain.momentum).norm(), gain.roundings)
          << given.transpose() << " given, " << gain.momentum.transpose() << " got";
      most_given = std::max(most_given, given.norm() / std::pow(spacing, 3.0));
      if (given.norm() > 0.0)
        largest_error = std::max(largest_error, (given - gain.momentum).norm() / given.norm());
      if (random() % 2 == 0) simulator.advance(0.01 * stop);
    }
  }
  std::printf("given up to %.3g cells' volumes times m/s, got but for %.1e of it\n", most_given,
              largest_error);
  EXPECT_GT(most_given, 0.01);
}

TEST(GivenMomentum, IsWhatAllSandGotWhenItMadeWay) { expectThatGivenIsGot(true, 12); }

TEST(GivenMomentum, IsWhatAllSandGotWhenItWasDragged) { expectThatGivenIsGot(false, 4); }

constexpr double kSpacing = 1.0 / 64.0;
constexpr double kSurface = 0.25;
const Eigen::Vector3d kSize(8.0 * kSpacing, 12.0 * kSpacing, 16.0 * kSpacing);

std::shared_ptr<const DistanceField> symmetricBox() {
  static const auto field = std::make_shared<const DistanceField>(
      mirroredField(mirroredField(computeDistanceField(triangulate(Box{kSize}), 0.5 * kSpacing), 0), 1));
  return field;
}

Eigen::Isometry3d at(const Eigen::Vector3d& place) { return Eigen::Isometry3d(Eigen::Translation3d(place)); }

/// A box in level sand, of 64 columns each way, that is here for the first time, with a velocity.
Simulator struckBy(const Eigen::Vector3d& place, const Eigen::Vector3d& velocity) {
  Simulator simulator = buildSimulator(levelSand({1.0, 1.0}, kSpacing, kSurface));
  const std::size_t body = simulator.addBody("box", symmetricBox());
  simulator.appendPose(body, -0.125, at(place - 0.125 * velocity));
  simulator.appendPose(body, 0.0, at(place));
  simulator.advance(0.0);
  return simulator;
}

/// A binary fraction, of which sums are not rounded.
double fraction(std::mt19937& random, int most) { return randomCount(random, -most, most) / 32.0; }

/// What columns give is the same in every bit, but is not added up in the same order.
TEST(GivenMomentum, IsMirroredWithTheBody) {
  std::mt19937 random = seededGenerator();
  for (int trial = 0; trial < 20; ++trial) {
    const double x = 0.5 + 0.25 * fraction(random, 16);
    const double y = 0.5 + 0.25 * fraction(random, 16);
    const double z = kSurface + 0.25 * fraction(random, 16);
    const double velocity_x = fraction(random, 32);
    const double velocity_y = fraction(random, 32);
    const double velocity_z = fraction(random, 32);
    const Simulator simulator = struckBy({x, y, z}, {velocity_x, velocity_y, velocity_z});
    const Simulator mirrored = struckBy({1.0 - x, y, z}, {-velocity_x, velocity_y, velocity_z});
    const Eigen::Vector2d one = givenBy(simulator, 0);
    const Eigen::Vector2d other = givenBy(mirrored, 0);
    // Each addition rounds by half of an epsilon of all that was added up to then.
    const double cells = simulator.grid().cells();
    const double bound = 4.0 * cells * 0.5 * DBL_EPSILON * kSurface * 3.0;
    EXPECT_NEAR(one.x(), -other.x(), bound);
    EXPECT_NEAR(one.y(), other.y(), bound);
    // Straight down or along y it gives nothing to the side.
    const Simulator symmetric = struckBy({0.5, y, z}, {0.0, velocity_y, velocity_z});
    EXPECT_NEAR(givenBy(symmetric, 0).x(), 0.0, bound);
  }
}

/// Faster than waves, so that no sand runs into it from behind: that would give it momentum forwards.
TEST(GivenMomentum, PointsWhereAFastBodyGoes) {
  std::mt19937 random = seededGenerator();
  for (int trial = 0; trial < 8; ++trial) {
    const double heading = uniform(random, -M_PI, M_PI);
    const Eigen::Vector2d along(std::cos(heading), std::sin(heading));
    const double speed = uniform(random, 1.0, 2.0) * std::sqrt(9.81 * kSurface);
    Simulator simulator = buildSimulator(levelSand({1.0, 1.0}, kSpacing, kSurface));
    const std::size_t body = simulator.addBody("box", symmetricBox());
    const Eigen::Vector2d from = Eigen::Vector2d(0.5, 0.5) - 0.15 * along;
    const Eigen::Vector2d to = Eigen::Vector2d(0.5, 0.5) + 0.15 * along;
    for (const PoseKey& key :
         straightMotion({from.x(), from.y(), kSurface}, {to.x(), to.y(), kSurface}, speed))
      simulator.appendPose(body, key.time, key.pose);
    Eigen::Vector2d before(0.0, 0.0);
    for (int part = 1; part <= 3; ++part) {
      simulator.advanceTo(part * 0.1 / speed);
      const Eigen::Vector2d given = givenBy(simulator, body) - before;
      before += given;
      EXPECT_GT(given.dot(along), 0.0) << "part " << part;
    }
  }
}

/// Two boxes in the sand, of which the second rests.
struct TwoBoxes {
  explicit TwoBoxes(double gap, const Eigen::Vector3d& velocity)
      : simulator(buildSimulator(levelSand({2.0, 1.0}, kSpacing, kSurface))) {
    const auto field = symmetricBox();
    moving = simulator.addBody("moving", field);
    resting = simulator.addBody("resting", field);
    const Eigen::Vector3d place(0.5, 0.5, kSurface);
    simulator.placeBody(resting, at(place + Eigen::Vector3d(kSize.x() + gap, 0.0, 0.0)));
    simulator.appendPose(moving, -0.125, at(place - 0.125 * velocity));
    simulator.appendPose(moving, 0.0, at(place));
    simulator.appendPose(moving, 0.0625, at(place + 0.0625 * velocity));
  }
  Simulator simulator;
  std::size_t moving;
  std::size_t resting;
};

TEST(GivenMomentum, IsThatOfTheBodyThatMoves) {
  TwoBoxes far(0.75, {0.5, 0.25, -0.25});
  far.simulator.advance(0.0625);
  EXPECT_GT(givenBy(far.simulator, far.moving).norm(), 0.0);
  EXPECT_EQ(givenBy(far.simulator, far.resting), Eigen::Vector2d::Zero());
  // The column between the two is pushed by the one that sinks.
  TwoBoxes side_by_side(kSpacing, {0.0, 0.0, -0.5});
  Simulator& simulator = side_by_side.simulator;
  simulator.advance(0.0);
  const int between = static_cast<int>((0.5 + 0.5 * (kSize.x() + kSpacing)) / kSpacing);
  EXPECT_GT(simulator.fields().momentum_x[simulator.grid().index(between, 32)], 0.0f);
  EXPECT_EQ(givenBy(simulator, side_by_side.resting), Eigen::Vector2d::Zero());
}

TEST(GivenMomentum, IsCountedAnewInSandThatIsRestored) {
  TwoBoxes boxes(0.75, {0.5, 0.25, -0.25});
  Simulator& simulator = boxes.simulator;
  simulator.advance(0.03125);
  const Snapshot middle = simulator.snapshot();
  simulator.advance(0.03125);
  simulator.restore(middle);
  EXPECT_EQ(givenByAll(simulator), Eigen::Vector2d::Zero());
  simulator.advance(0.03125);
  EXPECT_GT(givenBy(simulator, boxes.moving).x(), 0.0);
  simulator.removeBody(boxes.moving);
  simulator.advance(0.03125);
  ASSERT_EQ(simulator.contacts(simulator.fields()).size(), 1u);
}

}  // namespace
}  // namespace shallow_sand
