#include <gtest/gtest.h>

#include <cstdio>

#include "random_scene.h"
#include "random_seed.h"
#include "same_run.h"

namespace shallow_sand {
namespace {

constexpr int kScenes = 100;
constexpr int kFrames = 4;

/// Sizes that are no multiple of anything: small ones, down to a single cell; long thin ones; such that take
/// more than one rectangle along x; and such of many tiles.
Size randomSize(std::mt19937& random, int scene) {
  const auto count = [&](int least, int most) { return randomCount(random, least, most); };
  switch (scene % 5) {
    case 0:
      return {count(1, 4), count(1, 4)};
    case 1:
      return {count(1, 60), count(1, 60)};
    case 2:
      return random() % 2 == 0 ? Size{count(1, 5), count(100, 700)} : Size{count(100, 700), count(1, 5)};
    case 3:
      return {count(257, 600), count(10, 50)};
    default:
      return {count(60, 150), count(60, 150)};
  }
}

/// Much moves; or nothing does, but for what pours and bodies do.
RandomScene anyScene(std::mt19937& random, int scene) {
  const Size size = randomSize(random, scene);
  RandomSand sand = random() % 2 == 0 ? randomSand(random, size.columns, size.rows)
                                      : heldSand(random, size.columns, size.rows, uniform(random, 0.0, 20.0));
  if (random() % 2 == 0) sand.parameters.gravity = randomGravity(random, 3.0);
  return randomScene(random, std::move(sand), static_cast<int>(random() % 3),
                     random() % 3 == 0 ? 1 + static_cast<int>(random() % 2) : 0);
}

/// The same simulation, run in another way that must not change any bit.
struct Variant {
  std::string name;
  SimulatorParameters parameters;
};

/// The scene itself runs on one thread, sleeps, and takes the last of the instruction sets.
std::vector<Variant> variantsOf(const SimulatorParameters& parameters) {
  const std::vector<InstructionSet> sets = instructionSets();
  std::vector<Variant> variants{{"nothing sleeps", parameters}};
  variants.back().parameters.sleeping = false;
  for (const int threads : {2, 3}) {
    const InstructionSet set = sets[(threads - 2) % sets.size()];
    variants.push_back({std::to_string(threads) + " threads, " + toString(set), parameters});
    variants.back().parameters.threads = threads;
    variants.back().parameters.instructions = set;
  }
  return variants;
}

void expectValid(const Simulator& simulator) {
  const Fields fields = simulator.fields();
  for (std::size_t k = 0; k < fields.depth.size(); ++k) {
    ASSERT_TRUE(std::isfinite(fields.depth[k]) && fields.depth[k] >= 0.0f) << fields.depth[k];
    ASSERT_TRUE(std::isfinite(fields.momentum_x[k]) && std::isfinite(fields.momentum_y[k]));
  }
  // Each step rounds, and bodies that cross the map in a second make a thousand of them.
  const double steps = static_cast<double>(simulator.progress().steps);
  EXPECT_LT(simulator.ledger().error(), 1e-6 * std::max(1.0, steps / 400.0));
}

TEST(SameBits, HoweverTheStepIsComputed) {
  std::mt19937 random = seededGenerator();
  std::uint64_t steps = 0;
  for (int number = 0; number < kScenes && !HasFailure(); ++number) {
    const RandomScene scene = anyScene(random, number);
    const Grid grid = scene.sand.parameters.grid.grid();
    SCOPED_TRACE("scene " + std::to_string(number) + ": " + std::to_string(grid.columns) + " x " +
                 std::to_string(grid.rows) + " cells, " + std::to_string(scene.pours.size()) + " pours, " +
                 std::to_string(scene.bodies.size()) + " bodies");
    Simulator reference = simulatorOf(scene, scene.sand.parameters);
    const std::vector<Variant> variants = variantsOf(scene.sand.parameters);
    std::vector<Simulator> others;
    for (const Variant& variant : variants) others.push_back(simulatorOf(scene, variant.parameters));
    for (int frame = 0; frame < kFrames && !HasFailure(); ++frame) {
      reference.advance(scene.frame);
      expectValid(reference);
      for (std::size_t k = 0; k < variants.size(); ++k) {
        SCOPED_TRACE(variants[k].name);
        others[k].advance(scene.frame);
        expectSameRun(reference, others[k]);
        expectSameGivenMomentum(reference, others[k]);
      }
    }
    steps += reference.progress().steps;
  }
  std::printf("%d scenes, %llu steps\n", kScenes, static_cast<unsigned long long>(steps));
}

/// A column of sand that stands on a wide bed at rest.
RandomScene heapOnRest(std::mt19937& random) {
  const auto cells = [&](int least, int most) { return least + static_cast<int>(random() % (most - least)); };
  const int columns = cells(200, 320);
  RandomSand sand = heldSand(random, columns, cells(120, 200), uniform(random, 25.0, 35.0));
  const Grid grid = sand.parameters.grid.grid();
  const double radius = uniform(random, 3.0, 6.0) * grid.spacing;
  const Eigen::Vector2d place = randomPlace(random, grid, 30.0 * grid.spacing);
  addHeap(sand, place, radius);
  return sceneOf(random, std::move(sand));
}

TEST(SameBits, WhatRestsIsNotComputed) {
  std::mt19937 random = seededGenerator();
  for (int number = 0; number < 6; ++number) {
    SCOPED_TRACE("scene " + std::to_string(number));
    const RandomScene scene = heapOnRest(random);
    SimulatorParameters awake = scene.sand.parameters;
    awake.sleeping = false;
    Simulator sleeping = simulatorOf(scene, scene.sand.parameters);
    Simulator complete = simulatorOf(scene, awake);
    for (Simulator* simulator : {&sleeping, &complete}) simulator->advance(8.0 * scene.frame);
    expectSameRun(sleeping, complete);
    EXPECT_FALSE(sameBits(sleeping.fields().depth, scene.sand.depth));
    const double share = static_cast<double>(sleeping.progress().cell_updates) /
                         static_cast<double>(complete.progress().cell_updates);
    std::printf("%llu steps, %.1f %% of the cells computed\n",
                static_cast<unsigned long long>(sleeping.progress().steps), 100.0 * share);
    // The heap and its spread lie on at most nine tiles of fifty; the first step computes all.
    EXPECT_LT(share, 0.4);
  }
}

}  // namespace
}  // namespace shallow_sand
