#include <gtest/gtest.h>

#include <cstdio>

#include "random_edit.h"
#include "random_grains.h"
#include "random_scene.h"
#include "random_seed.h"
#include "same_run.h"
#include "shallow_sand/scene/geotiff.h"

/// Grains of simulations.
namespace shallow_sand {
namespace {

/// Much moves, or hardly anything does.
RandomScene sceneWithGrains(std::mt19937& random, int columns, int rows, int most_bodies) {
  RandomSand sand = random() % 2 == 0 ? randomSand(random, columns, rows)
                                      : heldSand(random, columns, rows, uniform(random, 0.0, 20.0));
  if (random() % 2 == 0) sand.parameters.gravity = randomGravity(random, 3.0);
  sand.parameters.grains = randomGrains(random, 12);
  return randomScene(random, std::move(sand), randomCount(random, 0, 2), randomCount(random, 0, most_bodies));
}

TEST(Grains, AreOneACellOfTheirLayerWhateverHappens) {
  std::mt19937 random = seededGenerator();
  std::size_t generated = 0;
  for (int number = 0; number < 20 && !HasFailure(); ++number) {
    const RandomScene scene =
        sceneWithGrains(random, randomCount(random, 1, 60), randomCount(random, 1, 40), 2);
    SCOPED_TRACE("scene " + std::to_string(number));
    Simulator simulator = simulatorOf(scene, scene.sand.parameters);
    for (int frame = 0; frame < 6 && !HasFailure(); ++frame) {
      simulator.advance(uniform(random, 0.0, 4.0) * scene.frame);
      if (random() % 3 == 0) simulator.edit(randomEdit(random, simulator.grid()));
      expectValid(simulator.grains());
    }
    for (const Grain& grain : simulator.grains().cells) generated += grain.born > 0 ? 1 : 0;
  }
  EXPECT_GT(generated, 0u);
}

TEST(Grains, AreTheSameHoweverTheyAreMoved) {
  std::mt19937 random = seededGenerator();
  std::size_t moved = 0;
  for (int number = 0; number < 20 && !HasFailure(); ++number) {
    const RandomScene scene =
        sceneWithGrains(random, randomCount(random, 1, 150), randomCount(random, 1, 60), 1);
    SCOPED_TRACE("scene " + std::to_string(number));
    SimulatorParameters threads = scene.sand.parameters;
    threads.threads = randomCount(random, 2, 3);
    SimulatorParameters awake = threads;
    awake.sleeping = false;
    Simulator one = simulatorOf(scene, scene.sand.parameters);
    Simulator several = simulatorOf(scene, threads);
    Simulator everywhere = simulatorOf(scene, awake);
    for (int frame = 0; frame < 4 && !HasFailure(); ++frame) {
      for (Simulator* simulator : {&one, &several, &everywhere}) simulator->advance(3.0 * scene.frame);
      const Grains grains = one.grains();
      EXPECT_TRUE(sameBits(grains.cells, several.grains().cells));
      EXPECT_TRUE(sameBits(grains.cells, everywhere.grains().cells));
    }
    const Grains start = simulatorOf(scene, scene.sand.parameters).grains();
    moved += countMoved(start.cells, one.grains().cells);
  }
  EXPECT_GT(moved, 0u);
}

TEST(Grains, DoNotChangeTheSand) {
  std::mt19937 random = seededGenerator();
  const RandomScene scene = sceneWithGrains(random, 40, 30, 2);
  SimulatorParameters without = scene.sand.parameters;
  without.grains.reset();
  Simulator with_grains = simulatorOf(scene, scene.sand.parameters);
  Simulator alone = simulatorOf(scene, without);
  for (Simulator* simulator : {&with_grains, &alone}) advanceFrames(*simulator, scene.frame, 0, 8);
  expectSameRun(with_grains, alone);
  EXPECT_TRUE(alone.grains().cells.empty());
}

TEST(Grains, KeepTheirBitsWhereSandRests) {
  std::mt19937 random = seededGenerator();
  for (int number = 0; number < 10; ++number) {
    RandomSand sand =
        heldSand(random, randomCount(random, 1, 60), randomCount(random, 1, 40), uniform(random, 0.0, 20.0));
    sand.parameters.grains = randomGrains(random, 16);
    Simulator simulator(sand.parameters, sand.bed, sand.depth);
    const Grains start = simulator.grains();
    for (int frame = 0; frame < 10; ++frame) simulator.advance(0.02);
    EXPECT_EQ(simulator.grains().moves, 10u);
    EXPECT_TRUE(sameBits(simulator.grains().cells, start.cells));
  }
}

/// Grains that are far from a heap that spreads on sand at rest.
TEST(Grains, MoveNowhereButWhereSandDoes) {
  std::mt19937 random = seededGenerator();
  RandomSand sand = heldSand(random, 120, 60, uniform(random, 25.0, 35.0));
  const Grid grid = sand.parameters.grid.grid();
  addHeap(sand, {grid.x(30), grid.y(30)}, uniform(random, 3.0, 5.0) * grid.spacing);
  sand.parameters.grains = randomGrains(random, 9);
  Simulator simulator(sand.parameters, sand.bed, sand.depth);
  const Grains start = simulator.grains();
  std::vector<bool> near_motion(grid.cells(), false);
  // Rough sand may fall and rest in a tenth of the time in which it falls a cell; grains go as it moves at
  // the end of each frame.
  const double frame = 0.05 * std::sqrt(grid.spacing / 9.81);
  for (int k = 0; k < 60; ++k) {
    simulator.advance(frame);
    const Fields fields = simulator.fields();
    for (int j = 0; j < grid.rows; ++j) {
      for (int i = 0; i < grid.columns; ++i) {
        const std::size_t cell = grid.index(i, j);
        if (fields.momentum_x[cell] == 0.0f && fields.momentum_y[cell] == 0.0f) continue;
        // Half a cell by Eq. 27, and as far as the fastest goes in a frame: that is less than two.
        for (int row = std::max(0, j - 4); row < std::min(grid.rows, j + 5); ++row) {
          for (int column = std::max(0, i - 4); column < std::min(grid.columns, i + 5); ++column)
            near_motion[grid.index(column, row)] = true;
        }
      }
    }
    ASSERT_LT(simulator.maxSpeed() * frame, 3.0 * grid.spacing);
  }
  const Grains end = simulator.grains();
  EXPECT_GT(countMoved(start.cells, end.cells), 0u);
  for (int t = 0; t < end.grid.rows; ++t) {
    for (int s = 0; s < end.grid.columns; ++s) {
      if (near_motion[grid.index(s / end.grid.per_cell, t / end.grid.per_cell)]) continue;
      const long long cell = end.grid.index(s, t, 0);
      ASSERT_EQ(std::memcmp(&start.cells[cell], &end.cells[cell], sizeof(Grain)), 0) << s << ", " << t;
    }
  }
}

TEST(Grains, GoOnFromASnapshotBitForBit) {
  std::mt19937 random = seededGenerator();
  for (int number = 0; number < 12 && !HasFailure(); ++number) {
    const RandomScene scene = sceneWithGrains(random, 40, 25, 2);
    Simulator whole = simulatorOf(scene, scene.sand.parameters);
    advanceFrames(whole, scene.frame, 0, 12);
    const int half = randomCount(random, 0, 11);
    Simulator first = simulatorOf(scene, scene.sand.parameters);
    advanceFrames(first, scene.frame, 0, half);
    Simulator second = simulatorOf(scene, scene.sand.parameters);
    second.restore(first.snapshot());
    advanceFrames(second, scene.frame, half, 12);
    EXPECT_EQ(second.grains().moves, whole.grains().moves);
    EXPECT_TRUE(sameBits(second.grains().cells, whole.grains().cells));
  }
}

TEST(Grains, StartAnewFromASavedState) {
  std::mt19937 random = seededGenerator();
  const RandomScene scene = sceneWithGrains(random, 40, 25, 1);
  Simulator simulator = simulatorOf(scene, scene.sand.parameters);
  advanceFrames(simulator, scene.frame, 0, 6);
  saveState("grains.tif", simulator.parameters(), simulator.snapshot());
  simulator.restore(loadState("grains.tif", simulator.parameters()));
  const Grains grains = simulator.grains();
  EXPECT_EQ(grains.moves, 0u);
  EXPECT_TRUE(sameBits(grains.cells, startingGrains(grains.grid, simulator.grid(), simulator.fields())));
}

TEST(Grains, ThatDoNotFitAreRefused) {
  std::mt19937 random = seededGenerator();
  RandomSand sand = randomSand(random, 8, 6);
  Simulator without(sand.parameters, sand.bed, sand.depth);
  sand.parameters.grains = GrainParameters();
  Simulator simulator(sand.parameters, sand.bed, sand.depth);
  EXPECT_THROW(without.restore(simulator.snapshot()), InvalidParameter);
  const auto refused = [&](const std::function<void(std::vector<Grain>&)>& spoil) {
    Snapshot snapshot = simulator.snapshot();
    spoil(snapshot.grains.cells);
    EXPECT_THROW(simulator.restore(snapshot), InvalidParameter);
  };
  refused([](std::vector<Grain>& grains) { grains.pop_back(); });
  refused([](std::vector<Grain>& grains) { grains[3].x = 1.0f; });
  refused([](std::vector<Grain>& grains) { grains[3].y = std::nanf(""); });
  refused([](std::vector<Grain>& grains) { grains[3].origin = static_cast<std::uint32_t>(grains.size()); });
}

/// Sand that a plate lifts and carries away keeps the grains that it had.
TEST(Grains, RideOnBodiesThatCarrySand) {
  std::mt19937 random = seededGenerator();
  constexpr double kCell = 0.05;
  SimulatorParameters parameters;
  parameters.grid.spacing = kCell;
  parameters.grid.size = {60 * kCell, 24 * kCell};
  parameters.backend = Backend::cpu;
  parameters.threads = 1;
  parameters.material.friction_angle = 35.0 * M_PI / 180.0;
  parameters.grains = GrainParameters();
  const Grid grid = parameters.grid.grid();
  RandomBody plate;
  plate.shape = Box{{12 * kCell, 10 * kCell, 2 * kCell}};
  const TriangleMesh mesh = triangulate(plate.shape);
  plate.field =
      std::make_shared<const DistanceField>(computeDistanceField(mesh, distanceSpacing(mesh, kCell)));
  const double start = uniform(random, 14.0, 16.0) * kCell;
  const double way = uniform(random, 22.0, 28.0) * kCell;
  const Eigen::Quaterniond level = Eigen::Quaterniond::Identity();
  const double middle = 12 * kCell;
  plate.motion = {{0.0, poseOf({start, middle}, 3 * kCell, level)},
                  {1.0, poseOf({start, middle}, 25 * kCell, level)},
                  {1.2, poseOf({start, middle}, 25 * kCell, level)},
                  {4.2, poseOf({start + way, middle}, 25 * kCell, level)}};
  Simulator simulator(parameters, std::vector<float>(grid.cells(), 0.0f),
                      std::vector<float>(grid.cells(), static_cast<float>(8 * kCell)));
  addTo(simulator, plate);
  while (simulator.time() < 4.4) simulator.advance(0.02);
  const Fields fields = simulator.fields();
  const Grains grains = simulator.grains();
  // Where much lies on the plate, far from its edges.
  int carried = 0;
  int from_start = 0;
  for (int t = 0; t < grains.grid.rows; ++t) {
    for (int s = 0; s < grains.grid.columns; ++s) {
      const std::size_t cell = grid.index(s / 4, t / 4);
      if (fields.load[cell] < kCell) continue;
      const double x = (s + 0.5) / 4 * kCell;
      if (std::abs(x - (start + way)) > 4 * kCell) continue;
      const double origin =
          (grains.cells[grains.grid.index(s, t, 0)].origin % grains.grid.columns + 0.5) / 4 * kCell;
      ++carried;
      from_start += std::abs(origin - (x - way)) < 3 * kCell ? 1 : 0;
    }
  }
  std::printf("%d of %d grains on the plate came with it\n", from_start, carried);
  ASSERT_GT(carried, 100);
  EXPECT_GT(from_start, carried * 8 / 10);
}

}  // namespace
}  // namespace shallow_sand
