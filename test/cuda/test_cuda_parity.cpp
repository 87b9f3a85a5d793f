#include <gtest/gtest.h>

#include <string>

#include "cuda_calls.h"
#include "parity.h"
#include "random_edit.h"

namespace shallow_sand {
namespace {

using CudaParity = CudaTest;

/// A size, and frames in which it is compared.
struct Map {
  Size size;
  int frames;
};

/// A tile is 32 cells wide and 4 high: one cell, single rows and columns, just under, at and over one tile,
/// and over two; with a large map at the end.
std::vector<Map> maps(const Map& large) {
  return {{{1, 1}, 10}, {{1, 7}, 10}, {{1, 40}, 2}, {{33, 1}, 4}, {{2, 2}, 10},
          {{31, 3}, 6}, {{32, 4}, 6}, {{33, 5}, 2}, {{65, 9}, 1}, large};
}

/// Compares a random scene on each map, with either reconstruction by turns; `most_bodies` is the largest
/// number of bodies in one. Returns the steps of all together.
std::uint64_t compareMaps(const Map& large, int pours, int most_bodies, bool displacement = true) {
  std::mt19937 random = seededGenerator();
  std::uint64_t steps = 0;
  bool with_slopes = random() % 2 == 0;
  for (const Map& map : maps(large)) {
    SCOPED_TRACE(std::to_string(map.size.columns) + " x " + std::to_string(map.size.rows));
    const int bodies = most_bodies > 0 ? randomCount(random, 1, most_bodies) : 0;
    RandomScene scene = tiltedScene(random, map.size, pours, bodies);
    scene.sand.parameters.coupling = displacement ? Coupling::displacement : Coupling::drag;
    scene.sand.parameters.solver.reconstruction =
        with_slopes ? Reconstruction::minmod : Reconstruction::constant;
    with_slopes = !with_slopes;
    Pair pair(scene);
    pair.advance(scene.frame, map.frames);
    steps += pair.steps();
  }
  return steps;
}

constexpr Map kOfSand{{70, 45}, 4};
constexpr Map kOfBodies{{40, 20}, 2};
constexpr std::uint64_t kSteps = 53;  // a frame takes at least one

TEST_F(CudaParity, SandAlone) { expectSteps(compareMaps(kOfSand, 0, 0), kSteps); }

TEST_F(CudaParity, PoursAndDrains) { expectSteps(compareMaps(kOfSand, 3, 0), kSteps); }

TEST_F(CudaParity, MovingBodies) { expectSteps(compareMaps(kOfBodies, 1, 3), kSteps); }

TEST_F(CudaParity, DragAlone) { expectSteps(compareMaps(kOfBodies, 1, 3, false), kSteps); }

/// One simulation with everything, in frames of many steps.
TEST_F(CudaParity, LongRunWithEverything) {
  std::mt19937 random = seededGenerator();
  RandomScene scene = tiltedScene(random, {17, 5}, 3, 2);
  scene.sand.parameters.grains = randomGrains(random, 4);
  Pair pair(scene);
  // A frame of the finest grid takes three of the longest steps.
  for (int frame = 0; frame < 70 && pair.steps() < 200 && !HasFailure(); ++frame) {
    pair.advance(10.0 * scene.frame, 1);
    const Edit edit = randomEdit(random, pair.cpu.grid());
    EXPECT_EQ(pair.cpu.edit(edit), pair.cuda.edit(edit));
    expectSame(pair.cpu, pair.cuda);
  }
  expectSteps(pair.steps(), 200);
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
