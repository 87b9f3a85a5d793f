#include <gtest/gtest.h>

#include <cstdio>

#include "random_scene.h"
#include "random_seed.h"
#include "shallow_sand/solver/sand_constants.h"

namespace shallow_sand {
namespace {

constexpr int kScenes = 30;

RandomScene movingScene(std::mt19937& random, int pours) {
  const int columns = 1 + static_cast<int>(random() % 60);
  RandomScene scene =
      randomScene(random, randomSand(random, columns, 1 + static_cast<int>(random() % 60)), pours, 0);
  // None is to be drained dry: what is asserted needs sand.
  for (Pour& pour : scene.pours) pour.rate = std::abs(pour.rate);
  return scene;
}

/// Longest step that Eq. 14 and 34 allow from the present state. [s]
double boundOf(const Simulator& simulator, const RandomSand& sand) {
  const Grid grid = simulator.grid();
  const SimulatorParameters& parameters = simulator.parameters();
  const SandConstants constants = sandConstants(grid, parameters.gravity, parameters.material);
  const LocalMaterialFields material = localMaterial(parameters.material, sand.material, grid);
  const Fields fields = simulator.fields();
  double fastest = 1e-9;
  for (std::size_t k = 0; k < grid.cells(); ++k) {
    const LocalMaterial local =
        material.repose_rise.empty()
            ? constants.uniform
            : LocalMaterial{material.repose_rise[k], material.layer_fraction[k], material.layer_depth[k]};
    const float inverse = inverseDepth(fields.depth[k], constants);
    const float u =
        std::max(std::abs(inverse * fields.momentum_x[k]), std::abs(inverse * fields.momentum_y[k]));
    fastest =
        std::max(fastest, static_cast<double>(u + waveSpeed(diluteLayer(fields.depth[k], local), constants)));
  }
  return parameters.solver.courant * grid.spacing / fastest;
}

TEST(Time, EveryStepKeepsItsBound) {
  std::mt19937 random = seededGenerator();
  for (int number = 0; number < kScenes; ++number) {
    SCOPED_TRACE("scene " + std::to_string(number));
    RandomScene scene = movingScene(random, 1);
    if (random() % 2 == 0) scene.sand.parameters.solver.max_step = 0.1 * scene.frame;
    Simulator simulator = simulatorOf(scene, scene.sand.parameters);
    double longest_share = 0.0;
    for (int step = 0; step < 60; ++step) {
      // A frame shorter than a step is one step: the state before each is known.
      const double bound = boundOf(simulator, scene.sand);
      if (bound > 10.0 * scene.frame) {
        // Dry until the pour begins. A share of this bound would be a frame of months.
        simulator.advance(scene.frame);
        continue;
      }
      const std::uint64_t steps = simulator.progress().steps;
      const double frame = uniform(random, 0.1, 1.1) * bound;
      simulator.advance(frame);
      if (simulator.progress().steps != steps + 1) continue;
      // Speeds are floats.
      ASSERT_LE(simulator.progress().last_step, bound * (1.0 + 1e-6));
      ASSERT_LE(simulator.progress().last_step, scene.sand.parameters.solver.max_step * (1.0 + 1e-9));
      longest_share = std::max(longest_share, simulator.progress().last_step / bound);
    }
    if (scene.sand.parameters.solver.max_step > scene.frame) {
      EXPECT_GT(longest_share, 0.5);
    }
  }
}

TEST(Time, AFixedStepIsTakenWhereItMay) {
  std::mt19937 random = seededGenerator();
  for (int number = 0; number < kScenes; ++number) {
    RandomScene scene = movingScene(random, 0);
    const double step = 0.01 * scene.frame;
    scene.sand.parameters.solver.fixed_step = step;
    Simulator simulator = simulatorOf(scene, scene.sand.parameters);
    simulator.advance(4.6 * step);
    EXPECT_EQ(simulator.progress().steps, 5u);
    EXPECT_NEAR(simulator.progress().last_step, 0.6 * step, 1e-6 * step);
  }
}

TEST(Time, ARefusedStepChangesNothing) {
  std::mt19937 random = seededGenerator();
  for (int number = 0; number < kScenes; ++number) {
    SCOPED_TRACE("scene " + std::to_string(number));
    RandomScene scene = movingScene(random, 0);
    const Grid grid = scene.sand.parameters.grid.grid();
    scene.sand.depth[grid.cells() / 2] = 5.0f * grid.spacing;  // nothing bounds steps where there is no sand
    const double too_long = 3.0 * boundOf(simulatorOf(scene, scene.sand.parameters), scene.sand);
    scene.sand.parameters.solver.fixed_step = too_long;
    Simulator refused = simulatorOf(scene, scene.sand.parameters);
    Simulator fresh = simulatorOf(scene, scene.sand.parameters);
    try {
      refused.advance(10.0 * too_long);
      FAIL() << "nothing was thrown";
    } catch (const InvalidParameter& problem) {
      EXPECT_NE(std::string(problem.what()).find("solver.fixed_step"), std::string::npos) << problem.what();
    }
    EXPECT_EQ(refused.time(), 0.0);
    EXPECT_EQ(refused.progress().steps, 0u);
    EXPECT_TRUE(sameBits(refused.fields().depth, scene.sand.depth));
    // Shorter frames are shorter steps, which may be taken.
    for (Simulator* simulator : {&refused, &fresh}) {
      for (int frame = 0; frame < 5; ++frame) simulator->advance(0.01 * too_long);
    }
    EXPECT_EQ(refused.time(), fresh.time());
    EXPECT_TRUE(sameBits(refused.fields().depth, fresh.fields().depth));
    EXPECT_TRUE(sameBits(refused.fields().momentum_x, fresh.fields().momentum_x));
    EXPECT_TRUE(sameBits(refused.fields().momentum_y, fresh.fields().momentum_y));
  }
}

/// By how much two runs may differ in what they poured: each step rounds the depth of each cell of the disc
/// by at most half a unit in its last place, and the depth that it adds by as much of that. [m³]
double roundingOfPour(const RandomScene& scene, const Simulator& one, const Simulator& other) {
  const double spacing = scene.sand.parameters.grid.spacing;
  double deepest = 0.0;
  for (const std::vector<float>& depth : {scene.sand.depth, one.fields().depth, other.fields().depth})
    deepest = std::max<double>(deepest, *std::max_element(depth.begin(), depth.end()));
  // It may have been deeper in between.
  const double half_unit = 2.0 * deepest * std::ldexp(1.0, -24);
  const double side = 2.0 * std::max(scene.pours.front().radius, 0.71 * spacing) + spacing;
  const auto steps = static_cast<double>(one.progress().steps + other.progress().steps);
  return steps * side * side * half_unit + one.ledger().poured * std::ldexp(1.0, -23);
}

TEST(Time, FramesOfAnyLengthEndWhereTheyShould) {
  std::mt19937 random = seededGenerator();
  for (int number = 0; number < kScenes; ++number) {
    const RandomScene scene = movingScene(random, 1);
    Simulator cut = simulatorOf(scene, scene.sand.parameters);
    Simulator whole = simulatorOf(scene, scene.sand.parameters);
    double end = 0.0;
    for (int frame = 0; frame < 10; ++frame) {
      const double length = scene.frame * std::exp(uniform(random, -8.0, 0.5));
      cut.advance(length);
      end += length;
      ASSERT_EQ(cut.time(), end);
    }
    whole.advance(end);
    EXPECT_EQ(whole.time(), end);
    EXPECT_LT(whole.ledger().error(), 1e-6);
    // What falls does not depend on the frames, but for the roundings of depths.
    EXPECT_NEAR(cut.ledger().poured, whole.ledger().poured, roundingOfPour(scene, cut, whole));
  }
}

double shareRepeated(const Simulator& simulator) {
  return static_cast<double>(simulator.progress().repeated_steps) /
         static_cast<double>(simulator.progress().steps);
}

/// A bound is known only once a step has met the speeds; to find it costs few steps.
TEST(Time, FewStepsAreRepeated) {
  std::mt19937 random = seededGenerator();
  for (const Reconstruction reconstruction : {Reconstruction::constant, Reconstruction::minmod}) {
    SimulatorParameters parameters;
    parameters.backend = Backend::cpu;
    parameters.threads = 1;
    parameters.grid.size = {1.5, 1.1};
    parameters.solver.reconstruction = reconstruction;
    parameters.solver.max_step = 1.0;  // only speeds bound steps
    const Grid grid = parameters.grid.grid();
    const std::vector<float> bare(grid.cells(), 0.0f);
    std::vector<float> column = bare;
    for (int j = 20; j < 40; ++j)
      for (int i = 20; i < 40; ++i) column[grid.index(i, j)] = 0.4f;
    Simulator collapse(parameters, bare, column);
    collapse.advance(1.0);
    Simulator poured(parameters, bare, bare);
    poured.addPour({{0.7, 0.5}, uniform(random, 0.05, 0.15), uniform(random, 0.002, 0.05), 0.0, 2.0});
    poured.advance(2.5);
    std::printf("repeated: %.1f %% of %llu steps of a collapse, %.1f %% of %llu steps of a pour\n",
                100.0 * shareRepeated(collapse), static_cast<unsigned long long>(collapse.progress().steps),
                100.0 * shareRepeated(poured), static_cast<unsigned long long>(poured.progress().steps));
    EXPECT_LT(shareRepeated(collapse), 0.25);
    EXPECT_LT(shareRepeated(poured), 0.25);
  }
}

}  // namespace
}  // namespace shallow_sand
