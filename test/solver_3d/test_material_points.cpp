#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <random>
#include <vector>

#include "random_seed.h"
#include "solver_3d/column_collapse.h"
#include "solver_3d/material_points.h"

namespace shallow_sand {
namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr double kGravity = 9.81;
constexpr double kSpacing = 0.05;

/// Sand a third as stiff as usual, to take longer steps.
MaterialPointParameters boxOf(int length, int width, int height) {
  MaterialPointParameters parameters;
  parameters.cells = {length, width, height};
  parameters.spacing = kSpacing;
  parameters.youngs_modulus = 1e5;
  parameters.friction_angle = 30.0 * kDegree;
  return parameters;
}

/// Depths of the columns of a box: depth(i, j) in metres.
template <class Depth>
std::vector<double> depthsOf(const MaterialPointParameters& box, const Depth& depth) {
  std::vector<double> depths;
  for (int j = 0; j < box.cells.y(); ++j) {
    for (int i = 0; i < box.cells.x(); ++i) depths.push_back(depth(i, j));
  }
  return depths;
}

/// A block of sand somewhere on the floor, as far as half of the box in each direction.
std::vector<double> randomBlock(const MaterialPointParameters& box, std::mt19937& random) {
  const auto draw = [&](int below) { return std::uniform_int_distribution<int>(0, below - 1)(random); };
  const int width = 2 + draw(box.cells.x() / 2 - 1);
  const int length = 2 + draw(box.cells.y() / 2 - 1);
  const int left = draw(box.cells.x() - width);
  const int front = draw(box.cells.y() - length);
  const double height = box.spacing * (2 + draw(box.cells.z() / 2 - 1));
  return depthsOf(box, [&](int i, int j) {
    return i >= left && i < left + width && j >= front && j < front + length ? height : 0.0;
  });
}

double energyOf(const MaterialPoints& sand) {
  return sand.kineticEnergy() + sand.elasticEnergy() + sand.potentialEnergy();
}

TEST(MaterialPoints, FallFreelyAndKeepTheirMomentum) {
  std::mt19937 random = seededGenerator();
  const MaterialPointParameters box = boxOf(16, 16, 24);
  MaterialPoints sand(box);
  sand.fill(depthsOf(box, [&](int i, int j) {
    return (i + j) % 16 > 6 && i > 3 && j > 3 && i < 12 && j < 12 ? 0.25 : 0.0;
  }));
  std::uniform_real_distribution<double> draw(-0.2, 0.2);
  const Eigen::Vector3d velocity(draw(random), draw(random), draw(random));
  sand.launch({0.0, 0.0, 0.8}, velocity);
  const Eigen::Vector3d start = sand.centre();
  const double duration = 0.35;
  sand.advance(duration);
  const Eigen::Vector3d gravity(0.0, 0.0, -kGravity);
  const Eigen::Vector3d expected = start + duration * velocity + 0.5 * duration * duration * gravity;
  // A step moves points with the velocity at its end; steps get a little shorter as sand gets faster.
  const double step = duration / static_cast<double>(sand.steps());
  const Eigen::Vector3d error = sand.centre() - expected;
  EXPECT_LT(error.head<2>().norm(), 1e-12);
  EXPECT_NEAR(-error.z(), 0.5 * kGravity * duration * step, 0.05 * kGravity * duration * step);
  const Eigen::Vector3d momentum = sand.mass() * (velocity + duration * gravity);
  EXPECT_LT((sand.momentum() - momentum).norm(), 1e-10 * momentum.norm());
  EXPECT_LT(sand.impulse().norm(), 1e-10 * momentum.norm());
}

TEST(MaterialPoints, MomentumIsWhatGravityAndTheBoxGave) {
  std::mt19937 random = seededGenerator();
  for (int n = 0; n < 3; ++n) {
    const MaterialPointParameters box = boxOf(12, 10, 12);
    MaterialPoints sand(box);
    sand.fill(randomBlock(box, random));
    sand.launch(Eigen::Vector3d::Zero(), {1.0, -0.5, 0.3});
    const Eigen::Vector3d start = sand.momentum();
    sand.advance(0.5);
    const Eigen::Vector3d pulled = 0.5 * sand.mass() * Eigen::Vector3d(0.0, 0.0, -kGravity);
    EXPECT_LT((sand.momentum() - start - pulled - sand.impulse()).norm(), 1e-9 * pulled.norm());
  }
}

TEST(MaterialPoints, SandBetweenWallsBearsItsWeightAndSinksAsItsStiffnessTells) {
  const MaterialPointParameters box = boxOf(4, 5, 12);
  MaterialPoints sand(box);
  const double height = 0.4;
  sand.fill(depthsOf(box, [&](int, int) { return height; }));
  const Eigen::Vector3d start = sand.centre();
  // Confined at the sides, the modulus is λ + 2µ. The mean of ρ g (h z - z²/2) / modulus:
  const double nu = box.poisson_ratio;
  const double modulus = box.youngs_modulus * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu));
  const double sinking = box.density * kGravity * height * height / (3.0 * modulus);
  // It starts unstressed, and swings: the means of two spans of five periods each.
  const double period = 4.0 * height / std::sqrt(modulus / box.density);
  for (int span = 0; span < 2; ++span) {
    constexpr int kSamples = 100;
    double sunk = 0.0;
    for (int n = 0; n < kSamples; ++n) {
      sand.advance(5.0 * period / kSamples);
      const Eigen::Vector3d moved = sand.centre() - start;
      sunk -= moved.z() / kSamples;
      EXPECT_LT(-moved.z(), 2.2 * sinking);
      EXPECT_LT(moved.head<2>().norm(), 1e-6 * height);
    }
    std::cout << "sinks by " << 1e3 * sunk << " mm, expected " << 1e3 * sinking << " mm\n";
    EXPECT_NEAR(sunk, sinking, 0.1 * sinking);
  }
  const Eigen::Vector3d force = sand.impulse() / sand.time();
  const double weight = sand.mass() * kGravity;
  EXPECT_NEAR(force.z(), weight, 0.02 * weight);
  EXPECT_LT(force.head<2>().norm(), 1e-6 * weight);
  for (const double depth : sand.depth()) EXPECT_NEAR(depth, height, 1e-9);
}

TEST(MaterialPoints, MassStaysAndEnergyNeverGrows) {
  std::mt19937 random = seededGenerator();
  for (int n = 0; n < 3; ++n) {
    const MaterialPointParameters box = boxOf(12, 10, 12);
    MaterialPoints sand(box);
    const std::vector<double> depths = randomBlock(box, random);
    sand.fill(depths);
    double volume = 0.0;
    for (const double depth : depths) volume += depth * kSpacing * kSpacing;
    const double start = energyOf(sand);
    double last = start;
    for (int frame = 0; frame < 30; ++frame) {
      sand.advance(0.02);
      const double now = energyOf(sand);
      EXPECT_LT(now, last + 1e-3 * start) << frame;
      last = now;
    }
    EXPECT_LT(last, start);
    double left = 0.0;
    for (const double depth : sand.depth()) left += depth * kSpacing * kSpacing;
    EXPECT_NEAR(left, volume, 1e-9 * volume);
    EXPECT_NEAR(sand.mass(), volume * box.density, 1e-9 * sand.mass());
  }
}

TEST(MaterialPoints, FloorSlowsSlidingSandByItsFriction) {
  const MaterialPointParameters box = boxOf(24, 8, 4);
  MaterialPoints sand(box);
  sand.fill(depthsOf(box, [&](int i, int) { return i >= 2 && i < 14 ? 0.05 : 0.0; }));
  constexpr double kSpeed = 2.0;
  constexpr double kDuration = 0.2;
  sand.launch(Eigen::Vector3d::Zero(), {kSpeed, 0.0, 0.0});
  sand.advance(kDuration);
  const double slowed = kSpeed - sand.momentum().x() / sand.mass();
  const double expected = std::tan(box.friction_angle) * kGravity * kDuration;
  std::cout << "slowed by " << slowed << " m/s, expected " << expected << " m/s\n";
  EXPECT_NEAR(slowed, expected, 0.05 * expected);
}

TEST(MaterialPoints, SandThatFellAndSplashedSettlesOnItsOldVolume) {
  const MaterialPointParameters box = boxOf(12, 4, 30);
  MaterialPoints sand(box);
  sand.fill(depthsOf(box, [&](int i, int) { return i < 4 ? 0.6 : 0.0; }));
  sand.launch({0.2, 0.0, 0.8}, {0.0, 0.0, -1.0});
  sand.advance(1.2);
  EXPECT_LT(sand.kineticEnergy(), 1e-3 * sand.potentialEnergy());
  double moment = 0.0;
  double volume = 0.0;
  for (const double depth : sand.depth()) {
    moment += 0.5 * depth * depth;
    volume += depth;
  }
  const double height = moment / volume;  // of the centre, if the sand has its density
  std::cout << "the centre comes to " << sand.centre().z() << " m, expected " << height << " m\n";
  EXPECT_NEAR(sand.centre().z(), height, 0.05 * height);
}

/// Angle of a heap's flank between 30 and 70 % of its height. [degrees]
double flankOf(const Profile& heap) {
  const double top = heap.depth[0];
  return std::atan(0.4 * top / (heap.reach(0.3 * top) - heap.reach(0.7 * top))) / kDegree;
}

/// A cone of 30 degrees' friction: as it was, and some time later.
struct Cone {
  Profile start;
  Profile end;

  Cone(double angle, double duration) {
    const MaterialPointParameters box = boxOf(24, 24, 11);
    MaterialPoints sand(box);
    Grid grid;
    grid.columns = box.cells.x();
    grid.rows = box.cells.y();
    grid.spacing = static_cast<float>(kSpacing);
    const double slope = std::tan(angle * kDegree);
    const double height = std::min(0.4, 0.45 * kSpacing * grid.columns * slope);
    sand.fill(depthsOf(box, [&](int i, int j) {
      return std::max(0.0, height - kSpacing * std::hypot(i - 11.5, j - 11.5) * slope);
    }));
    start = radialProfile(grid, sand.depth());
    sand.advance(duration);
    end = radialProfile(grid, sand.depth());
    std::cout << "a cone of " << flankOf(start) << " degrees comes to " << flankOf(end) << ", and differs by "
              << relativeDeviation(end, start) << '\n';
  }
};

TEST(MaterialPoints, ConesSlideIfTheyAreSteeperThanFrictionAllows) {
  const Cone flat(25.0, 0.3);
  EXPECT_NEAR(flankOf(flat.end), flankOf(flat.start), 1.0);
  EXPECT_LT(relativeDeviation(flat.end, flat.start), 0.05);
  const Cone steep(40.0, 0.7);
  EXPECT_GT(relativeDeviation(steep.end, steep.start), 0.2);
  // It overshoots: sand that slid comes to rest below the angle.
  EXPECT_LT(flankOf(steep.end), 30.0);
  EXPECT_GT(flankOf(steep.end), 25.0);
}

TEST(MaterialPoints, ThreadsChangeNoBit) {
  const auto run = [](int threads) {
    MaterialPointParameters box = boxOf(20, 16, 12);
    box.threads = threads;
    MaterialPoints sand(box);
    sand.fill(depthsOf(box, [](int i, int j) { return i > 4 && j > 2 && i + j < 22 ? 0.3 : 0.0; }));
    sand.advance(0.2);
    return sand;
  };
  const MaterialPoints one = run(1);
  const MaterialPoints three = run(3);
  EXPECT_EQ(one.centre(), three.centre());
  EXPECT_EQ(one.momentum(), three.momentum());
  EXPECT_EQ(one.elasticEnergy(), three.elasticEnergy());
  EXPECT_EQ(one.depth(), three.depth());
}

}  // namespace
}  // namespace shallow_sand
