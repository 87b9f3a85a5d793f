#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "cuda_device.h"
#include "random_grains.h"
#include "random_scene.h"
#include "random_seed.h"
#include "same_run.h"

namespace shallow_sand {

/// Tests that need a GPU.
class CudaTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string missing = cudaDeviceMissing();
    if (!missing.empty()) GTEST_SKIP() << missing;
  }
};

/// The same, with a scene that holds everything that takes memory of it.
class CudaSceneTest : public CudaTest {
 protected:
  void SetUp() override {
    CudaTest::SetUp();
    if (IsSkipped()) return;
    std::mt19937 random = seededGenerator();
    scene_ = randomScene(random, randomSand(random, 33, 5), 1, 2);
    scene_.sand.parameters.backend = Backend::cuda;
  }

  RandomScene scene_;
};

inline Simulator simulatorOn(Backend backend, const RandomScene& scene) {
  SimulatorParameters parameters = scene.sand.parameters;
  parameters.backend = backend;
  return simulatorOf(scene, parameters);
}

/// A random scene in tilted gravity.
inline RandomScene tiltedScene(std::mt19937& random, const Size& size, int pours, int bodies) {
  RandomSand sand = randomSand(random, size.columns, size.rows);
  sand.parameters.gravity = randomGravity(random, 3.0);
  return randomScene(random, std::move(sand), pours, bodies);
}

/// Everything that the façade tells, but for how many cells were computed: tiles are not the same.
inline void expectSame(const Simulator& one, const Simulator& other) {
  expectSameRun(one, other);
  expectSameGivenMomentum(one, other);
  EXPECT_EQ(one.ledger().start, other.ledger().start);
  EXPECT_EQ(one.bodyOverlap(), other.bodyOverlap());
  EXPECT_EQ(one.maxSpeed(), other.maxSpeed());
  EXPECT_EQ(one.activeCells(), other.activeCells());
  EXPECT_TRUE(sameBits(one.grains().cells, other.grains().cells));
}

/// A simulation on either backend, to which the same is done.
struct Pair {
  explicit Pair(const RandomScene& scene)
      : cpu(simulatorOn(Backend::cpu, scene)), cuda(simulatorOn(Backend::cuda, scene)) {}

  template <class Function>
  void both(const Function& function) {
    function(cpu);
    function(cuda);
  }
  /// Advances by so many frames, unless something failed before, and compares after each.
  void advance(double frame, int frames) {
    for (int k = 0; k < frames && !::testing::Test::HasFailure(); ++k) {
      SCOPED_TRACE("from " + std::to_string(cpu.time() / frame) + " frames on");
      both([&](Simulator& simulator) { simulator.advance(frame); });
      expectSame(cpu, cuda);
    }
  }
  std::uint64_t steps() const { return cpu.progress().steps; }

  Simulator cpu;
  Simulator cuda;
};

/// Tells how many steps were compared, and that they were enough: nobody shall take a test that runs nothing
/// for a proof.
inline void expectSteps(std::uint64_t steps, std::uint64_t least) {
  ::testing::Test::RecordProperty("steps", std::to_string(steps));
  if (::testing::Test::HasFailure()) return;
  EXPECT_GE(steps, least);
}

/// A body of randomBody that is as high is far above all sand and rocks. [m]
inline double highAbove(const RandomScene& scene) {
  double highest = 0.0;
  for (std::size_t k = 0; k < scene.sand.bed.size(); ++k)
    highest = std::max(highest, static_cast<double>(scene.sand.bed[k]) + scene.sand.depth[k]);
  return highest + 20.0 * scene.sand.parameters.grid.spacing;
}

/// Lets a body hover far above the sand wherever it goes.
inline void lift(const RandomScene& scene, RandomBody& body) {
  for (PoseKey& key : body.motion) key.pose.translation().z() = highAbove(scene);
}

}  // namespace shallow_sand
