#include <gtest/gtest.h>

#include "random_fields.h"
#include "random_seed.h"

namespace shallow_sand {
namespace {

constexpr int kScenes = 20;

/// Sizes that are no multiple of anything, down to a single row or column.
int randomCount(std::mt19937& random) { return 1 + static_cast<int>(random() % 60); }

Fields runSteps(const RandomSand& sand, int frames) {
  Simulator simulator(sand.parameters, sand.bed, sand.depth);
  for (int frame = 0; frame < frames; ++frame) simulator.advance(sand.parameters.solver.max_step);
  return simulator.fields();
}

TEST(StepLaws, VolumeIsKeptAndDepthNeverNegative) {
  std::mt19937 random = seededGenerator();
  for (int scene = 0; scene < kScenes; ++scene) {
    RandomSand sand = randomSand(random, randomCount(random), randomCount(random));
    sand.parameters.edges = randomEdges(random);
    sand.parameters.solver.courant = uniform(random, 0.1, 0.9);
    const double tilt = uniform(random, 0.0, 5.0);
    sand.parameters.gravity = {tilt, -0.5 * tilt, -9.81};
    Simulator simulator(sand.parameters, sand.bed, sand.depth);
    for (int frame = 0; frame < 10; ++frame) {
      simulator.advance(0.03);
      const Fields fields = simulator.fields();
      for (std::size_t k = 0; k < fields.depth.size(); ++k) {
        ASSERT_TRUE(std::isfinite(fields.depth[k]) && fields.depth[k] >= 0.0f) << fields.depth[k];
        ASSERT_TRUE(std::isfinite(fields.momentum_x[k]) && std::isfinite(fields.momentum_y[k]));
      }
    }
    EXPECT_LT(simulator.ledger().error(), 1e-6) << "scene " << scene;
  }
}

TEST(StepLaws, OnlyOpenEdgesLoseSand) {
  std::mt19937 random = seededGenerator();
  for (int scene = 0; scene < kScenes; ++scene) {
    RandomSand sand = randomSand(random, 12, 9);
    sand.parameters.gravity = {4.0, 0.0,
                               -4.0};  // flows towards larger x whatever its friction, which is under 45°
    sand.parameters.material.friction_angle = uniform(random, 5.0, 40.0) * M_PI / 180.0;
    std::fill(sand.bed.begin(), sand.bed.end(), 0.0f);
    std::fill(sand.depth.begin(), sand.depth.end(), static_cast<float>(10.0 * sand.parameters.grid.spacing));
    // In which sand falls through fifty cells.
    const double duration = 10.0 * std::sqrt(sand.parameters.grid.spacing / 9.81);
    {
      Simulator walled(sand.parameters, sand.bed, sand.depth);
      walled.advance(duration);
      EXPECT_EQ(walled.ledger().left, 0.0);
    }
    sand.parameters.edges.x_max = Edge::open;
    Simulator open(sand.parameters, sand.bed, sand.depth);
    open.advance(duration);
    EXPECT_GT(open.ledger().left, 0.01 * open.ledger().start);
    EXPECT_LT(open.ledger().error(), 1e-6);
  }
}

TEST(StepLaws, HeldSandKeepsEveryBit) {
  std::mt19937 random = seededGenerator();
  for (int scene = 0; scene < kScenes; ++scene) {
    const RandomSand sand = heldSand(random, randomCount(random), randomCount(random));
    const Fields after = runSteps(sand, 50);
    EXPECT_TRUE(sameBits(after.depth, sand.depth)) << "scene " << scene;
    for (std::size_t k = 0; k < after.depth.size(); ++k) {
      ASSERT_EQ(after.momentum_x[k], 0.0f);
      ASSERT_EQ(after.momentum_y[k], 0.0f);
    }
  }
}

TEST(StepLaws, SteeperSandMoves) {
  std::mt19937 random = seededGenerator();
  SimulatorParameters parameters;
  parameters.backend = Backend::cpu;
  parameters.grid.size = {0.6, 0.2};
  const Grid grid = parameters.grid.grid();
  const double angle = uniform(random, 10.0, 50.0) * M_PI / 180.0;
  parameters.material.friction_angle = angle;
  std::vector<float> depth(grid.cells());
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      depth[grid.index(i, j)] = static_cast<float>(1.0 + 1.02 * std::tan(angle) * grid.x(i));
    }
  }
  Simulator simulator(parameters, std::vector<float>(grid.cells(), 0.0f), depth);
  simulator.advance(0.1);
  EXPECT_GT(simulator.activeCells(), 0u);
}

/// Reflects or transposes a scene; fields of the result must be those of the original, reflected alike.
struct Symmetry {
  const char* name;
  bool transposes;
  double sign_x;
  double sign_y;
};

std::vector<float> transformed(const std::vector<float>& values, const Grid& grid, const Symmetry& symmetry) {
  std::vector<float> result(values.size());
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      const int x = symmetry.sign_x < 0.0 ? grid.columns - 1 - i : i;
      const int y = symmetry.sign_y < 0.0 ? grid.rows - 1 - j : j;
      const std::size_t target =
          symmetry.transposes ? static_cast<std::size_t>(x) * grid.rows + y : grid.index(x, y);
      result[target] = values[grid.index(i, j)];
    }
  }
  return result;
}

RandomSand transformed(RandomSand sand, const Symmetry& symmetry) {
  const Grid grid = sand.parameters.grid.grid();
  sand.bed = transformed(sand.bed, grid, symmetry);
  sand.depth = transformed(sand.depth, grid, symmetry);
  Eigen::Vector3d& gravity = sand.parameters.gravity;
  gravity = {symmetry.sign_x * gravity.x(), symmetry.sign_y * gravity.y(), gravity.z()};
  Edges& edges = sand.parameters.edges;
  if (symmetry.sign_x < 0.0) std::swap(edges.x_min, edges.x_max);
  if (symmetry.sign_y < 0.0) std::swap(edges.y_min, edges.y_max);
  if (symmetry.transposes) {
    std::swap(gravity.x(), gravity.y());
    std::swap(edges.x_min, edges.y_min);
    std::swap(edges.x_max, edges.y_max);
    sand.parameters.grid.size = {sand.parameters.grid.size.y(), sand.parameters.grid.size.x()};
  }
  return sand;
}

TEST(StepLaws, MirroredAndTransposedScenesGiveTheSameBits) {
  std::mt19937 random = seededGenerator();
  for (const Symmetry& symmetry : {Symmetry{"mirror x", false, -1, 1}, Symmetry{"mirror y", false, 1, -1},
                                   Symmetry{"transpose", true, 1, 1}}) {
    for (int scene = 0; scene < kScenes; ++scene) {
      RandomSand sand = randomSand(random, randomCount(random), randomCount(random));
      sand.parameters.edges = randomEdges(random);
      sand.parameters.gravity = randomGravity(random, 3.0);
      const Grid grid = sand.parameters.grid.grid();
      const Fields original = runSteps(sand, 20);
      const Fields other = runSteps(transformed(sand, symmetry), 20);
      ASSERT_TRUE(sameBits(transformed(original.depth, grid, symmetry), other.depth))
          << symmetry.name << ", scene " << scene;
      const std::vector<float> x = transformed(original.momentum_x, grid, symmetry);
      const std::vector<float> y = transformed(original.momentum_y, grid, symmetry);
      const std::vector<float>& other_x = symmetry.transposes ? other.momentum_y : other.momentum_x;
      const std::vector<float>& other_y = symmetry.transposes ? other.momentum_x : other.momentum_y;
      for (std::size_t k = 0; k < x.size(); ++k) {
        ASSERT_EQ(symmetry.sign_x * x[k], other_x[k]) << symmetry.name;
        ASSERT_EQ(symmetry.sign_y * y[k], other_y[k]) << symmetry.name;
      }
    }
  }
}

TEST(StepLaws, ThreadsChangeNoBit) {
  std::mt19937 random = seededGenerator();
  for (int scene = 0; scene < kScenes; ++scene) {
    RandomSand sand = randomSand(random, randomCount(random), randomCount(random));
    sand.parameters.edges = randomEdges(random);
    const Fields one = runSteps(sand, 20);
    for (const int threads : {2, 3}) {
      sand.parameters.threads = threads;
      const Fields many = runSteps(sand, 20);
      EXPECT_TRUE(sameBits(one.depth, many.depth)) << threads << " threads, scene " << scene;
      EXPECT_TRUE(sameBits(one.momentum_x, many.momentum_x)) << threads << " threads, scene " << scene;
      EXPECT_TRUE(sameBits(one.momentum_y, many.momentum_y)) << threads << " threads, scene " << scene;
    }
  }
}

TEST(StepLaws, AdvanceEndsAtItsTime) {
  std::mt19937 random = seededGenerator();
  const RandomSand sand = randomSand(random, 20, 20);
  Simulator simulator(sand.parameters, sand.bed, sand.depth);
  double expected = 0.0;
  for (int frame = 0; frame < 20; ++frame) {
    const double duration = uniform(random, 0.0, 0.1);
    simulator.advance(duration);
    expected += duration;
    EXPECT_EQ(simulator.time(), expected);
  }
  EXPECT_THROW(simulator.advance(-1.0), InvalidParameter);
  EXPECT_THROW(simulator.advance(std::nan("")), InvalidParameter);
}

TEST(StepLaws, FixedStepIsRefusedWhenItBreaksItsBound) {
  std::mt19937 random = seededGenerator();
  RandomSand sand = randomSand(random, 30, 30);
  sand.parameters.solver.fixed_step = 100.0 * sand.parameters.grid.spacing;
  Simulator simulator(sand.parameters, sand.bed, sand.depth);
  EXPECT_THROW(simulator.advance(1000.0 * sand.parameters.grid.spacing), InvalidParameter);
}

}  // namespace
}  // namespace shallow_sand
