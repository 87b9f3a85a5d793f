#include <gtest/gtest.h>

#include <string>

#include "cuda_calls.h"
#include "parity.h"

namespace shallow_sand {
namespace {

using CudaGrains = CudaTest;

/// Compares frames of random scenes with grains; sand goes some cells in each.
void compareScenes(int pours, int bodies) {
  std::mt19937 random = seededGenerator();
  std::size_t moved = 0;
  for (const Size& size : {Size{1, 1}, Size{1, 9}, Size{33, 5}, Size{40, 13}}) {
    SCOPED_TRACE(std::to_string(size.columns) + " x " + std::to_string(size.rows));
    RandomScene scene = tiltedScene(random, size, pours, bodies);
    scene.sand.parameters.grains = randomGrains(random, 12);
    Pair pair(scene);
    const Grains start = pair.cuda.grains();
    pair.advance(3.0 * scene.frame, 3);
    expectValid(pair.cuda.grains());
    moved += countMoved(start.cells, pair.cuda.grains().cells);
  }
  EXPECT_GT(moved, 0u);
}

TEST_F(CudaGrains, AreThoseOfTheCpu) { compareScenes(1, 0); }

TEST_F(CudaGrains, AreThoseOfTheCpuAmongBodies) { compareScenes(1, 2); }

/// A heap spreads on sand at rest: tiles that are awake are not those of the CPU.
TEST_F(CudaGrains, AreThoseOfTheCpuWhereMuchSleeps) {
  std::mt19937 random = seededGenerator();
  RandomSand sand = heldSand(random, 100, 24, uniform(random, 25.0, 35.0));
  const Grid grid = sand.parameters.grid.grid();
  addHeap(sand, {grid.x(randomCount(random, 10, 40)), grid.y(12)}, uniform(random, 3.0, 4.0) * grid.spacing);
  sand.parameters.grains = randomGrains(random, 4);
  const RandomScene scene = sceneOf(random, std::move(sand));
  Pair pair(scene);
  const Grains start = pair.cuda.grains();
  pair.advance(scene.frame, 6);
  const std::size_t moved = countMoved(start.cells, pair.cuda.grains().cells);
  EXPECT_GT(moved, 0u);
  EXPECT_LT(moved, start.cells.size() / 2);
}

TEST_F(CudaGrains, GoOnFromASnapshot) {
  std::mt19937 random = seededGenerator();
  RandomScene scene = tiltedScene(random, {20, 12}, 1, 1);
  scene.sand.parameters.grains = randomGrains(random, 9);
  Simulator whole = simulatorOn(Backend::cpu, scene);
  advanceFrames(whole, scene.frame, 0, 6);
  for (const Backend from : {Backend::cpu, Backend::cuda}) {
    Simulator first = simulatorOn(from, scene);
    advanceFrames(first, scene.frame, 0, 3);
    Pair second(scene);
    second.both([&](Simulator& simulator) {
      simulator.restore(first.snapshot());
      advanceFrames(simulator, scene.frame, 3, 6);
      EXPECT_TRUE(sameBits(simulator.grains().cells, whole.grains().cells));
    });
  }
}

/// The host takes part in no move, and asks for no memory.
TEST_F(CudaGrains, TakeFourLaunchesAMoveAndNoMemory) {
  std::mt19937 random = seededGenerator();
  RandomScene scene = tiltedScene(random, {33, 5}, 0, 0);
  scene.sand.parameters.backend = Backend::cuda;
  RandomScene with_grains = scene;
  with_grains.sand.parameters.grains = randomGrains(random, 9);
  Simulator without = simulatorOf(scene, scene.sand.parameters);
  Simulator with = simulatorOf(with_grains, with_grains.sand.parameters);
  const auto launchesOf = [&](Simulator& simulator) {
    const std::size_t before = launches();
    for (int frame = 0; frame < 3; ++frame) simulator.advance(scene.frame);
    return launches() - before;
  };
  const std::size_t memory = allocations();
  EXPECT_EQ(launchesOf(with), launchesOf(without) + 3 * 4);
  EXPECT_EQ(allocations(), memory);
}

}  // namespace
}  // namespace shallow_sand
