#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "random_bodies.h"
#include "random_fields.h"
#include "random_seed.h"

namespace shallow_sand {
namespace {

/// Everything that a run of both backends starts from.
struct ParityScene {
  RandomSand sand;
  std::vector<Pour> pours;
  std::vector<RandomBody> bodies;
  double frame = 0.0;  ///< [s]
};

ParityScene randomScene(std::mt19937& random, int columns, int rows, int pours, int bodies) {
  ParityScene scene;
  scene.sand = randomSand(random, columns, rows);
  SimulatorParameters& parameters = scene.sand.parameters;
  parameters.edges = randomEdges(random);
  parameters.gravity = {uniform(random, -3.0, 3.0), uniform(random, -3.0, 3.0), -9.81};
  parameters.solver.courant = uniform(random, 0.2, 0.9);
  parameters.solver.max_step = 0.1;
  const double spacing = parameters.grid.spacing;
  // About the time of a few steps.
  scene.frame = std::sqrt(spacing / 9.81);
  const Grid grid = parameters.grid.grid();
  for (int k = 0; k < pours; ++k) {
    Pour pour;
    pour.position = randomPlace(random, grid, 0.0);
    pour.radius = uniform(random, 0.1, 6.0) * spacing;
    pour.rate = uniform(random, 0.0, 10.0) * spacing * spacing * spacing / scene.frame;
    pour.start = uniform(random, 0.0, 2.0) * scene.frame;
    pour.stop = pour.start + uniform(random, 1.0, 8.0) * scene.frame;
    scene.pours.push_back(pour);
  }
  for (int k = 0; k < bodies; ++k) {
    scene.bodies.push_back(randomBody(random, spacing));
    moveThroughSand(random, scene.sand, 10.0 * scene.frame, scene.bodies.back());
  }
  return scene;
}

Simulator simulatorOn(Backend backend, const ParityScene& scene) {
  SimulatorParameters parameters = scene.sand.parameters;
  parameters.backend = backend;
  Simulator simulator(parameters, scene.sand.bed, scene.sand.depth);
  for (const Pour& pour : scene.pours) simulator.addPour(pour);
  for (const RandomBody& body : scene.bodies) addTo(simulator, body);
  return simulator;
}

void expectSame(const Simulator& cpu, const Simulator& cuda) {
  const Fields a = cpu.fields();
  const Fields b = cuda.fields();
  EXPECT_TRUE(sameBits(a.bed, b.bed));
  EXPECT_TRUE(sameBits(a.depth, b.depth));
  EXPECT_TRUE(sameBits(a.momentum_x, b.momentum_x));
  EXPECT_TRUE(sameBits(a.momentum_y, b.momentum_y));
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
void compare(const ParityScene& scene, std::uint64_t& steps) {
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
    SimulatorParameters parameters;
    parameters.grid.size = {parameters.grid.spacing, parameters.grid.spacing};
    parameters.backend = Backend::cuda;
    try {
      Simulator simulator(parameters, {0.0f}, {0.0f});
    } catch (const InvalidParameter& reason) {
      GTEST_SKIP() << reason.what();
    }
  }
};

struct Size {
  int columns;
  int rows;
};

/// Blocks of the launcher are 32 cells wide and 4 high: one cell, single rows and columns, just under, at and
/// over.
constexpr Size kSizes[] = {{1, 1}, {1, 7}, {33, 1}, {2, 2}, {31, 3}, {32, 4}, {33, 5}, {70, 45}};

/// Compares a random scene of every size; `most_bodies` is the largest number of bodies in one.
void compareAllSizes(int pours, int most_bodies) {
  std::mt19937 random = seededGenerator();
  std::uint64_t steps = 0;
  for (const Size& size : kSizes) {
    SCOPED_TRACE(std::to_string(size.columns) + " x " + std::to_string(size.rows));
    const int bodies = most_bodies > 0 ? 1 + static_cast<int>(random() % most_bodies) : 0;
    compare(randomScene(random, size.columns, size.rows, pours, bodies), steps);
  }
  EXPECT_GT(steps, 0u);
  ::testing::Test::RecordProperty("steps", std::to_string(steps));
}

TEST_F(CudaParity, SandAlone) { compareAllSizes(0, 0); }

TEST_F(CudaParity, Pours) { compareAllSizes(2, 0); }

TEST_F(CudaParity, MovingBodies) { compareAllSizes(1, 3); }

}  // namespace
}  // namespace shallow_sand
