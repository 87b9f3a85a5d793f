#include <gtest/gtest.h>

#include <cstdio>

#include "random_fields.h"
#include "random_seed.h"

namespace shallow_sand {
namespace {

constexpr int kScenes = 12;
constexpr int kSteps = 1000;

int randomCount(std::mt19937& random) { return 1 + static_cast<int>(random() % 50); }

/// Neither the time step nor the way in which the step is computed may matter to sand at rest. Nothing
/// sleeps: every step has to prove it.
void computeInAnyWay(std::mt19937& random, RandomSand& sand) {
  sand.parameters.solver.reconstruction =
      random() % 2 == 0 ? Reconstruction::constant : Reconstruction::minmod;
  sand.parameters.solver.courant = uniform(random, 0.1, 0.9);
  sand.parameters.solver.max_step = std::exp(uniform(random, std::log(1e-5), std::log(0.01)));
  sand.parameters.sleeping = false;
  const std::vector<InstructionSet> sets = instructionSets();
  sand.parameters.instructions = sets[random() % sets.size()];
}

void expectEveryBitKept(const RandomSand& sand) {
  Simulator simulator(sand.parameters, sand.bed, sand.depth, sand.material);
  while (simulator.progress().steps < kSteps) simulator.advance(100.0 * sand.parameters.solver.max_step);
  const Fields after = simulator.fields();
  EXPECT_TRUE(sameBits(after.depth, sand.depth));
  const std::vector<float> none(sand.depth.size(), 0.0f);
  EXPECT_TRUE(sameBits(after.momentum_x, none));
  EXPECT_TRUE(sameBits(after.momentum_y, none));
}

TEST(Rest, HeldSandKeepsEveryBit) {
  std::mt19937 random = seededGenerator();
  for (int scene = 0; scene < kScenes; ++scene) {
    SCOPED_TRACE("scene " + std::to_string(scene));
    const int columns = randomCount(random);
    RandomSand sand = heldSand(random, columns, randomCount(random));
    computeInAnyWay(random, sand);
    expectEveryBitKept(sand);
  }
}

/// A surface as steep as it likes, on sand that is everywhere just rough enough to hold it.
RandomSand sandHeldByItsOwnFriction(std::mt19937& random) {
  const int columns = randomCount(random);
  RandomSand sand = heldSand(random, columns, randomCount(random), uniform(random, 0.0, 5.0));
  const Grid grid = sand.parameters.grid.grid();
  const Eigen::Vector3d& g = sand.parameters.gravity;
  const auto rise = [&](int i, int j, int to_i, int to_j) {
    if (to_i < 0 || to_j < 0 || to_i >= grid.columns || to_j >= grid.rows) return 0.0;
    const auto surface = [&](std::size_t k) { return static_cast<double>(sand.bed[k]) + sand.depth[k]; };
    const double level = -(g.x() * (to_i - i) + g.y() * (to_j - j)) * grid.spacing / g.z();
    const std::size_t other = grid.index(to_i, to_j);
    const double rise = surface(other) - level - surface(grid.index(i, j));
    return sand.depth[other] > 0.0f ? std::abs(rise) : std::abs(std::min(rise, 0.0));
  };
  sand.material.friction_angle.resize(grid.cells());
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      const double along_x = std::max(rise(i, j, i - 1, j), rise(i, j, i + 1, j));
      const double along_y = std::max(rise(i, j, i, j - 1), rise(i, j, i, j + 1));
      const double friction = 1.03 * std::hypot(along_x, along_y) / grid.spacing + 1e-3;
      sand.material.friction_angle[grid.index(i, j)] = static_cast<float>(std::atan(friction));
    }
  }
  return sand;
}

TEST(Rest, SandHeldByTheFrictionOfItsPlaceKeepsEveryBit) {
  std::mt19937 random = seededGenerator();
  for (int scene = 0; scene < kScenes; ++scene) {
    SCOPED_TRACE("scene " + std::to_string(scene));
    RandomSand sand = sandHeldByItsOwnFriction(random);
    computeInAnyWay(random, sand);
    expectEveryBitKept(sand);
  }
}

/// A surface at right angles to gravity over a bed with cliffs, islands and dry basins behind them. All
/// elevations and the tilt of gravity are binary fractions, so that level means level in every bit.
RandomSand lake(std::mt19937& random) {
  const int columns = randomCount(random);
  const int rows = randomCount(random);
  RandomSand sand = randomSand(random, columns, rows);
  const double spacing = 1.0 / 32.0;
  sand.parameters.grid.spacing = spacing;
  sand.parameters.grid.size = {columns * spacing, rows * spacing};
  const Grid grid = sand.parameters.grid.grid();
  const int tilt_x = static_cast<int>(random() % 9) - 4;
  const int tilt_y = static_cast<int>(random() % 9) - 4;
  sand.parameters.gravity = {-1.0 * tilt_x, -1.0 * tilt_y, -8.0};
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      const std::size_t k = grid.index(i, j);
      const double level = 4.0 - (tilt_x * i + tilt_y * j) * spacing / 8.0;
      const int rock = static_cast<int>(random() % 2048) - (random() % 4 == 0 ? 0 : 2048);
      sand.bed[k] = static_cast<float>(level + rock / 4096.0);
      sand.depth[k] = std::max(0.0f, static_cast<float>(level) - sand.bed[k]);
    }
  }
  return sand;
}

TEST(Rest, ALakeWithoutFrictionKeepsEveryBit) {
  std::mt19937 random = seededGenerator();
  for (int scene = 0; scene < kScenes; ++scene) {
    SCOPED_TRACE("scene " + std::to_string(scene));
    RandomSand sand = lake(random);
    sand.parameters.material.friction_angle = 0.0;
    computeInAnyWay(random, sand);
    expectEveryBitKept(sand);
  }
}

TEST(Rest, AFlatSurfaceOverCliffsAndIslandsKeepsEveryBit) {
  std::mt19937 random = seededGenerator();
  for (int scene = 0; scene < kScenes; ++scene) {
    SCOPED_TRACE("scene " + std::to_string(scene));
    RandomSand sand = lake(random);
    if (random() % 2 == 0) varyMaterial(random, sand);
    computeInAnyWay(random, sand);
    expectEveryBitKept(sand);
  }
}

/// A plane of sand whose slope is `steepness` of what friction holds, in a walled box.
RandomSand inclinedSand(std::mt19937& random, double steepness, double heading) {
  RandomSand sand = randomSand(random, 37, 41);
  const Grid grid = sand.parameters.grid.grid();
  sand.parameters.material.friction_angle = uniform(random, 15.0, 45.0) * M_PI / 180.0;
  const double slope = steepness * std::tan(sand.parameters.material.friction_angle);
  sand.bed.assign(grid.cells(), 0.0f);
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      const double along = (i - 18) * std::cos(heading) + (j - 20) * std::sin(heading);
      sand.depth[grid.index(i, j)] = static_cast<float>((100.0 + slope * along) * grid.spacing);
    }
  }
  return sand;
}

/// Length of the surface's gradient where it is largest, by central differences as in Eq. 18; a wall is level
/// with the sand before it.
double steepestSlope(const Grid& grid, const Fields& fields) {
  const auto surface = [&](int i, int j) {
    const std::size_t k = grid.index(std::clamp(i, 0, grid.columns - 1), std::clamp(j, 0, grid.rows - 1));
    return static_cast<double>(fields.bed[k]) + static_cast<double>(fields.depth[k]);
  };
  double steepest = 0.0;
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      steepest = std::max(
          steepest, std::hypot(surface(i + 1, j) - surface(i - 1, j), surface(i, j + 1) - surface(i, j - 1)));
    }
  }
  return steepest / (2.0 * grid.spacing);
}

/// How far the sand that still has momentum goes in a step, in roundings of its depth; where that is little
/// no depth changes, depths being floats, and it may go on for ever.
double creep(const Grid& grid, const Fields& fields, double step) {
  double furthest = 0.0;
  for (std::size_t k = 0; k < fields.depth.size(); ++k) {
    const float h = fields.depth[k];
    const double rounding = std::nextafter(h, 2.0f * h) - h;
    const double momentum = std::hypot(fields.momentum_x[k], fields.momentum_y[k]);
    furthest = std::max(furthest, momentum * step / grid.spacing / rounding);
  }
  return furthest;
}

TEST(Rest, SlopesJustTooSteepMoveAndEndHeldInAnyDirection) {
  std::mt19937 random = seededGenerator();
  for (const Reconstruction reconstruction : {Reconstruction::constant, Reconstruction::minmod}) {
    for (const double degrees : {0.0, 22.5, 45.0, 90.0}) {
      SCOPED_TRACE((reconstruction == Reconstruction::minmod ? "minmod " : "constant ") +
                   std::to_string(degrees));
      RandomSand sand = inclinedSand(random, 1.02, degrees * M_PI / 180.0);
      sand.parameters.solver.reconstruction = reconstruction;
      const double unit = std::sqrt(sand.parameters.grid.spacing / 9.81);
      Simulator simulator(sand.parameters, sand.bed, sand.depth);
      simulator.advance(unit);
      EXPECT_GT(simulator.activeCells(), 0u);
      double time = 1.0;
      Fields before;
      Fields fields = simulator.fields();
      do {
        before = std::move(fields);
        simulator.advance(10.0 * unit);
        time += 10.0;
        fields = simulator.fields();
      } while (!sameBits(fields.depth, before.depth) && time < 3000.0);
      EXPECT_TRUE(sameBits(fields.depth, before.depth));
      const std::uint64_t steps = simulator.progress().steps;
      simulator.advance(10.0 * unit);
      const double step = 10.0 * unit / static_cast<double>(simulator.progress().steps - steps);
      const double creeping = creep(simulator.grid(), fields, step);
      EXPECT_LT(creeping, 10.0);
      const double steepest =
          steepestSlope(simulator.grid(), fields) / std::tan(sand.parameters.material.friction_angle);
      std::printf(
          "%s, %4.1f deg: at rest after %.0f sqrt(spacing/g), steepest slope %.4f of the friction's, %zu "
          "cells creep by %.1f roundings a step\n",
          reconstruction == Reconstruction::minmod ? "minmod  " : "constant", degrees, time, steepest,
          simulator.activeCells(), creeping);
      // Friction holds a thousandth more than it brakes; the rest are roundings.
      EXPECT_LT(steepest, simulator.activeCells() == 0 ? 1.002 : 1.005);
      EXPECT_LT(simulator.ledger().error(), 1e-6);
    }
  }
}

TEST(Rest, SlopesJustHeldStayInAnyDirection) {
  std::mt19937 random = seededGenerator();
  for (const double degrees : {0.0, 22.5, 45.0, 67.5, 90.0, 200.0}) {
    SCOPED_TRACE(degrees);
    RandomSand sand = inclinedSand(random, 0.99, degrees * M_PI / 180.0);
    computeInAnyWay(random, sand);
    expectEveryBitKept(sand);
  }
}

}  // namespace
}  // namespace shallow_sand
