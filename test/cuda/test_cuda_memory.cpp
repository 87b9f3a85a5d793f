#include <gtest/gtest.h>

#include "cuda_calls.h"
#include "parity.h"

namespace shallow_sand {
namespace {

using CudaMemory = CudaSceneTest;

/// Frames of which the fields are collected while the next one runs.
void run(Simulator& simulator, const RandomScene& scene) {
  for (int frame = 0; frame < 6; ++frame) {
    simulator.requestFields();
    simulator.beginAdvanceTo(simulator.time() + scene.frame);
    simulator.collectFields();
  }
  simulator.bodyOverlap();
}

TEST_F(CudaMemory, SandThatRunsTakesNoMore) {
  scene_.bodies.clear();
  Simulator simulator = simulatorOf(scene_, scene_.sand.parameters);
  simulator.advance(scene_.frame);
  simulator.fields();
  const std::size_t before = allocations();
  EXPECT_GT(before, 0u);
  run(simulator, scene_);
  EXPECT_EQ(allocations(), before);
}

TEST_F(CudaMemory, BodiesOnTheSameWayAgainTakeNoMore) {
  Simulator simulator = simulatorOf(scene_, scene_.sand.parameters);
  const Snapshot start = simulator.snapshot();
  run(simulator, scene_);
  const Fields first = simulator.fields();
  EXPECT_FALSE(sameBits(first.depth, scene_.sand.depth));
  simulator.restore(start);
  const std::size_t before = allocations();
  run(simulator, scene_);
  EXPECT_EQ(allocations(), before);
  expectSameBits(simulator.fields(), first);
}

TEST_F(CudaMemory, SimulatorGivesItAllBack) {
  const std::size_t before = allocationsHeld();
  {
    Simulator simulator = simulatorOf(scene_, scene_.sand.parameters);
    simulator.advance(scene_.frame);
    simulator.bodyOverlap();
    EXPECT_GT(allocationsHeld(), before);
  }
  EXPECT_EQ(allocationsHeld(), before);
}

}  // namespace
}  // namespace shallow_sand
