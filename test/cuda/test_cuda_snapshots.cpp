#include <gtest/gtest.h>

#include <string>

#include "parity.h"
#include "random_edit.h"
#include "same_run.h"

namespace shallow_sand {
namespace {

using CudaSnapshots = CudaTest;

constexpr int kFrames = 6;

/// Either backend takes a snapshot on the way; both go on from it.
void compareHalves(const RandomScene& scene, int half) {
  Simulator whole = simulatorOn(Backend::cpu, scene);
  advanceFrames(whole, scene.frame, 0, kFrames);
  for (const Backend from : {Backend::cpu, Backend::cuda}) {
    SCOPED_TRACE("taken on " + toString(from) + " after frame " + std::to_string(half));
    Simulator first = simulatorOn(from, scene);
    advanceFrames(first, scene.frame, 0, half);
    const Snapshot snapshot = first.snapshot();
    Pair second(scene);
    second.both([&](Simulator& simulator) {
      simulator.restore(snapshot);
      advanceFrames(simulator, scene.frame, half, kFrames);
    });
    expectSame(second.cpu, second.cuda);
    expectSameButForRoundings(whole, second.cuda);
  }
}

void compareScenes(int pours, int bodies) {
  std::mt19937 random = seededGenerator();
  for (const Size& size : {Size{1, 6}, Size{33, 5}, Size{20, 12}}) {
    SCOPED_TRACE(std::to_string(size.columns) + " x " + std::to_string(size.rows));
    const RandomScene scene = tiltedScene(random, size, pours, bodies);
    compareHalves(scene, randomCount(random, 0, kFrames - 1));
  }
}

TEST_F(CudaSnapshots, SandGoesOn) { compareScenes(2, 0); }

TEST_F(CudaSnapshots, SandAmongBodiesGoesOn) { compareScenes(1, 2); }

TEST_F(CudaSnapshots, SandUnderBodiesThatHoverGoesOn) {
  std::mt19937 random = seededGenerator();
  RandomScene scene = tiltedScene(random, {20, 12}, 0, 2);
  lift(scene, scene.bodies.front());
  compareHalves(scene, kFrames / 2);
}

TEST_F(CudaSnapshots, SimulatorGoesBack) {
  std::mt19937 random = seededGenerator();
  const RandomScene scene = tiltedScene(random, {20, 12}, 1, 2);
  Pair pair(scene);
  pair.advance(scene.frame, 2);
  const Snapshot early = pair.cuda.snapshot();
  pair.advance(scene.frame, 2);
  const Edit edit = randomEdit(random, pair.cpu.grid());
  pair.both([&](Simulator& simulator) {
    simulator.edit(edit);
    simulator.restore(early);
  });
  expectSame(pair.cpu, pair.cuda);
  pair.advance(scene.frame, 4);
}

TEST_F(CudaSnapshots, BodiesComeWhereThereWereNone) {
  std::mt19937 random = seededGenerator();
  RandomScene scene = tiltedScene(random, {20, 12}, 0, 2);
  RandomScene empty = scene;
  empty.bodies.clear();
  Simulator before = simulatorOn(Backend::cuda, empty);
  advanceFrames(before, scene.frame, 0, 2);
  const Snapshot snapshot = before.snapshot();
  Pair pair(scene);
  pair.both([&](Simulator& simulator) { simulator.restore(snapshot); });
  expectSame(pair.cpu, pair.cuda);
  pair.advance(scene.frame, 4);
}

}  // namespace
}  // namespace shallow_sand
