#include <gtest/gtest.h>

#include "random_fields.h"
#include "random_seed.h"

namespace shallow_sand {
namespace {

constexpr int kPlain = 8;  // cells

/// Rock steeper than friction holds, bumpy, with a plain at its foot and a layer on it of random depth up to
/// `deepest` cells.
RandomSand layerOnRock(std::mt19937& random, int columns, double deepest) {
  RandomSand sand = randomSand(random, columns, 1 + static_cast<int>(random() % 12));
  const Grid grid = sand.parameters.grid.grid();
  const double slope = uniform(random, 2.5, 4.0) * std::tan(sand.parameters.material.friction_angle);
  const std::vector<float> bumps = randomWaves(random, grid);
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      const std::size_t k = grid.index(i, j);
      const double rise = slope * std::max(0, grid.columns - kPlain - i);
      sand.bed[k] = static_cast<float>((rise + 0.2 * static_cast<double>(bumps[k])) * grid.spacing);
      sand.depth[k] = static_cast<float>(uniform(random, 0.0, deepest) * grid.spacing);
    }
  }
  sand.parameters.solver.reconstruction =
      random() % 2 == 0 ? Reconstruction::constant : Reconstruction::minmod;
  return sand;
}

/// Sand no deeper than a hundredth of a cell sticks to whatever it lies on.
TEST(Films, StickToSteepRock) {
  std::mt19937 random = seededGenerator();
  for (int scene = 0; scene < 40; ++scene) {
    SCOPED_TRACE("scene " + std::to_string(scene));
    const RandomSand sand = layerOnRock(random, 9 + static_cast<int>(random() % 50), 0.00999);
    Simulator simulator(sand.parameters, sand.bed, sand.depth);
    simulator.advance(1.0);
    EXPECT_EQ(simulator.activeCells(), 0u);
    EXPECT_LT(simulator.ledger().error(), 1e-6);
  }
}

}  // namespace
}  // namespace shallow_sand
