#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "parity.h"

namespace shallow_sand {
namespace {

using CudaSleep = CudaTest;

/// Sand at rest, four tiles wide; with a heap at one end, if there is to be one.
RandomScene sandAtRest(std::mt19937& random, bool with_heap) {
  RandomSand sand = heldSand(random, 100, 24, uniform(random, 25.0, 35.0));
  const Grid grid = sand.parameters.grid.grid();
  const double radius = uniform(random, 3.0, 4.0) * grid.spacing;
  if (with_heap) addHeap(sand, {grid.x(16), grid.y(12)}, radius);
  return sceneOf(random, std::move(sand));
}

TEST_F(CudaSleep, AHeapSpreadsOnSandOfWhichMuchSleeps) {
  std::mt19937 random = seededGenerator();
  const RandomScene scene = sandAtRest(random, true);
  Pair pair(scene);
  pair.advance(scene.frame, 6);
  EXPECT_FALSE(sameBits(pair.cuda.fields().depth, scene.sand.depth));
  const std::uint64_t cells = scene.sand.depth.size();
  // The first step computes all.
  EXPECT_GE(pair.cuda.progress().cell_updates, cells);
  EXPECT_LT(pair.cuda.progress().cell_updates, pair.steps() * cells * 6 / 10);
  expectSteps(pair.steps(), 6);
}

TEST_F(CudaSleep, WhereNothingMovesNoCellIsComputed) {
  std::mt19937 random = seededGenerator();
  const RandomScene scene = sandAtRest(random, false);
  Pair pair(scene);
  pair.advance(scene.frame, 1);
  const Progress before = pair.cuda.progress();
  EXPECT_GT(before.cell_updates, 0u);
  pair.advance(scene.frame, 2);
  EXPECT_GT(pair.cuda.progress().steps, before.steps);
  EXPECT_EQ(pair.cuda.progress().cell_updates, before.cell_updates);
  EXPECT_EQ(pair.cuda.activeCells(), 0u);
}

/// Bodies that hover, and move, are no reason to compute sand.
TEST_F(CudaSleep, UnderBodiesThatHoverFarAboveNoCellIsComputed) {
  std::mt19937 random = seededGenerator();
  RandomScene scene = sandAtRest(random, false);
  scene.bodies.push_back(randomBody(random, scene.sand.parameters.grid.spacing));
  moveThroughSand(random, scene.sand, 3.0 * scene.frame, scene.bodies.back());
  lift(scene, scene.bodies.back());
  Pair pair(scene);
  pair.advance(scene.frame, 1);
  const Progress before = pair.cuda.progress();
  pair.advance(scene.frame, 2);
  EXPECT_GT(pair.cuda.progress().steps, before.steps);
  EXPECT_EQ(pair.cpu.progress().cell_updates, before.cell_updates);
  EXPECT_EQ(pair.cuda.progress().cell_updates, before.cell_updates);
}

}  // namespace
}  // namespace shallow_sand
