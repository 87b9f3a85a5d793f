#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "cuda_calls.h"
#include "cuda_device.h"
#include "random_scene.h"
#include "random_seed.h"

namespace shallow_sand {
namespace {

Simulator simulatorOn(Backend backend, const RandomScene& scene) {
  SimulatorParameters parameters = scene.sand.parameters;
  parameters.backend = backend;
  return simulatorOf(scene, parameters);
}

RandomScene tiltedScene(std::mt19937& random, int columns, int rows, int pours, int bodies) {
  RandomSand sand = randomSand(random, columns, rows);
  sand.parameters.gravity = randomGravity(random, 3.0);
  return randomScene(random, std::move(sand), pours, bodies);
}

void expectSame(const Simulator& cpu, const Simulator& cuda) {
  expectSameBits(cpu.fields(), cuda.fields());
  const Ledger one = cpu.ledger();
  const Ledger other = cuda.ledger();
  EXPECT_EQ(one.start, other.start);
  EXPECT_EQ(one.poured, other.poured);
  EXPECT_EQ(one.left, other.left);
  EXPECT_EQ(one.now, other.now);
  EXPECT_EQ(cpu.progress().steps, cuda.progress().steps);
  EXPECT_EQ(cpu.progress().last_step, cuda.progress().last_step);
  EXPECT_EQ(cpu.time(), cuda.time());
  EXPECT_EQ(cpu.bodyOverlap(), cuda.bodyOverlap());
  EXPECT_EQ(cpu.maxSpeed(), cuda.maxSpeed());
  EXPECT_EQ(cpu.activeCells(), cuda.activeCells());
}

/// Steps of all scenes together; told, so that nobody takes a test that runs nothing for a proof.
void compare(const RandomScene& scene, std::uint64_t& steps) {
  Simulator cpu = simulatorOn(Backend::cpu, scene);
  Simulator cuda = simulatorOn(Backend::cuda, scene);
  for (int frame = 0; frame < 10 && !::testing::Test::HasFailure(); ++frame) {
    cpu.advance(scene.frame);
    cuda.advance(scene.frame);
    expectSame(cpu, cuda);
  }
  steps += cpu.progress().steps;
}

class CudaParity : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string missing = cudaDeviceMissing();
    if (!missing.empty()) GTEST_SKIP() << missing;
  }
};

/// Blocks of the launcher are 32 cells wide and 4 high: one cell, single rows and columns, just under, at and
/// over.
constexpr Size kSizes[] = {{1, 1}, {1, 7}, {33, 1}, {2, 2}, {31, 3}, {32, 4}, {33, 5}, {70, 45}};

/// Compares a random scene of every size, by turns with either reconstruction; `most_bodies` is the largest
/// number of bodies in one.
void compareAllSizes(int pours, int most_bodies) {
  std::mt19937 random = seededGenerator();
  std::uint64_t steps = 0;
  bool with_slopes = false;
  for (const Size& size : kSizes) {
    SCOPED_TRACE(std::to_string(size.columns) + " x " + std::to_string(size.rows));
    const int bodies = most_bodies > 0 ? 1 + static_cast<int>(random() % most_bodies) : 0;
    RandomScene scene = tiltedScene(random, size.columns, size.rows, pours, bodies);
    scene.sand.parameters.solver.reconstruction =
        with_slopes ? Reconstruction::minmod : Reconstruction::constant;
    compare(scene, steps);
    with_slopes = !with_slopes;
  }
  EXPECT_GT(steps, 0u);
  ::testing::Test::RecordProperty("steps", std::to_string(steps));
}

TEST_F(CudaParity, SandAlone) { compareAllSizes(0, 0); }

TEST_F(CudaParity, Pours) { compareAllSizes(2, 0); }

TEST_F(CudaParity, MovingBodies) { compareAllSizes(1, 3); }

TEST_F(CudaParity, DragAlone) {
  std::mt19937 random = seededGenerator();
  RandomScene scene = tiltedScene(random, 33, 5, 0, 3);
  scene.sand.parameters.displacement = false;
  std::uint64_t steps = 0;
  compare(scene, steps);
  EXPECT_GT(steps, 0u);
}

/// A kernel that no test has launched, no test has compared.
class EveryKernel : public ::testing::Environment {
 public:
  void TearDown() override {
    const auto& tests = *::testing::UnitTest::GetInstance();
    if (tests.test_to_run_count() < tests.total_test_count() || !cudaDeviceMissing().empty()) return;
    for (const std::string& kernel : kernelsNeverLaunched()) ADD_FAILURE() << "never launched: " << kernel;
  }
};

const ::testing::Environment* const kEveryKernel = ::testing::AddGlobalTestEnvironment(new EveryKernel);

}  // namespace
}  // namespace shallow_sand
