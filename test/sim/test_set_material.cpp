#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "random_grains.h"
#include "random_material.h"
#include "random_scene.h"
#include "random_seed.h"
#include "same_run.h"

namespace shallow_sand {
namespace {

constexpr double kDegree = M_PI / 180.0;

RandomScene busyScene(std::mt19937& random) {
  RandomSand sand = random() % 2 == 0
                        ? randomSand(random, randomCount(random, 1, 90), randomCount(random, 1, 50))
                        : heldSand(random, randomCount(random, 1, 90), randomCount(random, 1, 50));
  sand.parameters.gravity = randomGravity(random, 2.0);
  sand.parameters.threads = randomCount(random, 1, 2);
  const int pours = randomCount(random, 0, 2);
  return randomScene(random, std::move(sand), pours, randomCount(random, 0, 2));
}

/// One is given other values and its own again before every frame, the other is left alone.
TEST(SetMaterial, WhatIsSetBackChangesNoBit) {
  std::mt19937 random = seededGenerator();
  for (int number = 0; number < 20 && !HasFailure(); ++number) {
    SCOPED_TRACE("scene " + std::to_string(number));
    RandomScene scene = busyScene(random);
    if (random() % 2 == 0) scene.sand.parameters.grains = randomGrains(random, 4);
    Simulator alone = simulatorOf(scene, scene.sand.parameters);
    Simulator set = simulatorOf(scene, scene.sand.parameters);
    for (int frame = 0; frame < 10 && !HasFailure(); ++frame) {
      const SimulatorParameters own = set.parameters();
      set.setMaterial(otherMaterial(random, set, scene.sand.material));
      set.setGravity(otherGravity(random));
      set.setMaterial(own.material);
      set.setGravity(own.gravity);
      advanceFrames(alone, scene.frame, frame, frame + 1);
      advanceFrames(set, scene.frame, frame, frame + 1);
      expectSameRun(alone, set);
      EXPECT_TRUE(sameBits(alone.grains().cells, set.grains().cells));
      EXPECT_EQ(alone.maxSpeed(), set.maxSpeed());
      EXPECT_EQ(alone.activeCells(), set.activeCells());
    }
  }
}

/// Some of it sleeps when it is told.
TEST(SetMaterial, NewSandIsAsOneThatWasBuiltOfItAndTookOverTheSnapshot) {
  std::mt19937 random = seededGenerator();
  for (int number = 0; number < 40 && !HasFailure(); ++number) {
    const RandomScene scene = busyScene(random);
    Simulator changed = simulatorOf(scene, scene.sand.parameters);
    const int half = randomCount(random, 0, 20);
    SCOPED_TRACE("scene " + std::to_string(number) + ", changed after frame " + std::to_string(half));
    advanceFrames(changed, scene.frame, 0, half);
    const Snapshot before = changed.snapshot();
    SimulatorParameters wanted = scene.sand.parameters;
    if (random() % 3 != 0) wanted.material = otherMaterial(random, changed, scene.sand.material);
    if (random() % 3 != 0) wanted.gravity = otherGravity(random);
    changed.setMaterial(wanted.material);
    changed.setGravity(wanted.gravity);
    EXPECT_EQ(changed.parameters().material.friction_angle, wanted.material.friction_angle);
    EXPECT_EQ(changed.parameters().gravity, wanted.gravity);

    Simulator anew = simulatorOf(scene, wanted);
    anew.restore(before);
    EXPECT_EQ(anew.parameters().gravity, wanted.gravity) << "a snapshot brings no parameters";
    EXPECT_EQ(anew.maxSpeed(), changed.maxSpeed());
    advanceFrames(changed, scene.frame, half, half + 10);
    advanceFrames(anew, scene.frame, half, half + 10);
    expectSameButForRoundings(changed, anew);
  }
}

/// A cone on the flat bed in the middle of a map, with a slope [rad].
struct Cone {
  SimulatorParameters parameters;
  std::vector<float> bed;
  std::vector<float> depth;
};

Cone randomCone(std::mt19937& random, double slope) {
  Cone cone;
  cone.parameters.grid.size = {4.0, 4.0};
  cone.parameters.grid.spacing = 0.04;
  cone.parameters.backend = Backend::cpu;
  const Grid grid = cone.parameters.grid.grid();
  const double x = 2.0 + uniform(random, -0.1, 0.1);
  const double y = 2.0 + uniform(random, -0.1, 0.1);
  const double height = uniform(random, 0.4, 0.6);
  cone.bed.assign(grid.cells(), 0.0f);
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      const double distance = std::hypot(grid.x(i) - x, grid.y(j) - y);
      cone.depth.push_back(static_cast<float>(std::max(0.0, height - distance * std::tan(slope))));
    }
  }
  return cone;
}

TEST(SetMaterial, SandThatRestedSlidesWhenFrictionDrops) {
  std::mt19937 random = seededGenerator();
  Cone cone = randomCone(random, uniform(random, 28.0, 32.0) * kDegree);
  cone.parameters.material.friction_angle = 35.0 * kDegree;
  Simulator simulator(cone.parameters, cone.bed, cone.depth);
  simulator.advance(1.0);
  ASSERT_EQ(simulator.activeCells(), 0u);
  ASSERT_TRUE(sameBits(simulator.fields().depth, cone.depth));

  Material loose = cone.parameters.material;
  loose.friction_angle = 25.0 * kDegree;
  simulator.setMaterial(loose);
  simulator.advance(0.1);
  EXPECT_GT(simulator.activeCells(), 0u);
  while (simulator.activeCells() > 0) {
    ASSERT_LT(simulator.time(), 30.0) << simulator.activeCells() << " cells still move";
    simulator.advance(0.5);
  }
  const Ledger ledger = simulator.ledger();
  EXPECT_LT(ledger.error(), 1e-6);
  EXPECT_EQ(ledger.poured, 0.0);
  const std::vector<float> depth = simulator.fields().depth;
  const double height = *std::max_element(depth.begin(), depth.end());
  // Of a cone of that volume whose flanks stand at 25°.
  const double steepest = std::cbrt(3.0 * ledger.now / M_PI * std::pow(std::tan(loose.friction_angle), 2));
  EXPECT_LT(height, 1.02 * steepest);
  EXPECT_GT(height, 0.7 * steepest);
}

TEST(SetMaterial, SandThatRestedSlidesWhenGravityLeans) {
  std::mt19937 random = seededGenerator();
  Cone cone = randomCone(random, uniform(random, 10.0, 20.0) * kDegree);
  cone.parameters.material.friction_angle = 25.0 * kDegree;
  Simulator simulator(cone.parameters, cone.bed, cone.depth);
  simulator.advance(1.0);
  ASSERT_EQ(simulator.activeCells(), 0u);
  const double tilt = uniform(random, 28.0, 40.0) * kDegree;
  simulator.setGravity({9.81 * std::sin(tilt), 0.0, -9.81 * std::cos(tilt)});
  simulator.advance(0.5);
  const Fields fields = simulator.fields();
  double along = 0.0;
  double across = 0.0;
  for (std::size_t k = 0; k < fields.depth.size(); ++k) {
    along += fields.momentum_x[k];
    across += fields.momentum_y[k];
  }
  EXPECT_GT(along, 0.0);
  EXPECT_LT(std::abs(across), 0.1 * along);
  EXPECT_LT(simulator.ledger().error(), 1e-6);
}

std::string refusal(Simulator& simulator, const Material& material) {
  try {
    simulator.setMaterial(material);
  } catch (const InvalidParameter& problem) {
    return problem.what();
  }
  return "";
}

TEST(SetMaterial, BadValuesAreRefusedAndChangeNothing) {
  std::mt19937 random = seededGenerator();
  const RandomSand sand = randomSand(random, 20, 10);
  Simulator simulator(sand.parameters, sand.bed, sand.depth);
  const auto refused = [&](const std::string& key, const std::function<void(Material&)>& spoil) {
    Material material = sand.parameters.material;
    spoil(material);
    EXPECT_EQ(refusal(simulator, material).rfind(key + ": ", 0), 0u) << refusal(simulator, material);
    EXPECT_EQ(simulator.parameters().material.friction_angle, sand.parameters.material.friction_angle);
  };
  refused("material.friction_angle", [](Material& m) { m.friction_angle = 0.5 * M_PI; });
  refused("material.friction_angle", [](Material& m) { m.friction_angle = std::nan(""); });
  refused("material.dilute_layer.fraction", [](Material& m) { m.layer_fraction = 0.0; });
  refused("material.dilute_layer.depth", [](Material& m) { m.layer_depth = 0.0; });
  EXPECT_THROW(simulator.setGravity({0.0, 0.0, 0.0}), InvalidParameter);
  EXPECT_THROW(simulator.setGravity({std::nan(""), 0.0, -9.81}), InvalidParameter);
  EXPECT_EQ(simulator.parameters().gravity, sand.parameters.gravity);
}

TEST(SetMaterial, WhatAMapGivesIsRefusedByName) {
  std::mt19937 random = seededGenerator();
  RandomSand sand = randomSand(random, 20, 10);
  sand.material.friction_angle.assign(200, static_cast<float>(40.0 * kDegree));
  sand.parameters.material.friction_angle = 32.0 * kDegree;
  Simulator simulator(sand.parameters, sand.bed, sand.depth, sand.material);
  Material other = sand.parameters.material;
  other.friction_angle = 30.0 * kDegree;
  EXPECT_EQ(refusal(simulator, other),
            "material.friction_angle: 30; expected 32 as it is, for a map gives it cell by cell");
  other.friction_angle = sand.parameters.material.friction_angle;
  other.layer_fraction = 0.5;
  EXPECT_EQ(refusal(simulator, other), "");
  EXPECT_EQ(simulator.parameters().material.layer_fraction, 0.5);
}

}  // namespace
}  // namespace shallow_sand
