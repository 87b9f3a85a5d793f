#include <gtest/gtest.h>

#include <numeric>

#include "random_fields.h"
#include "random_seed.h"
#include "shallow_sand/surface/blocks.h"

namespace shallow_sand {
namespace {

Grid randomGrid(std::mt19937& random) {
  const int columns = randomCount(random, 1, 90);
  return randomSand(random, columns, randomCount(random, 1, 90)).parameters.grid.grid();
}

/// Ground, and loads here and there.
Fields randomLoads(std::mt19937& random, const Grid& grid) {
  Fields fields;
  fields.bed = randomWaves(random, grid);
  fields.depth = randomWaves(random, grid);
  fields.addLoads();
  fields.load = randomWaves(random, grid);
  for (std::size_t k = 0; k < grid.cells(); ++k) {
    fields.depth[k] = std::max(fields.depth[k], 0.0f);
    fields.load[k] = std::max(fields.load[k], 0.0f);
    fields.load_elevation[k] = fields.load[k] > 0.0f ? static_cast<float>(uniform(random, 1.0, 2.0)) : 0.0f;
  }
  return fields;
}

/// Of a quantity of each cell over the map. Value: of a cell's index.
template <class Value>
double integral(const Lattice& lattice, const Value& value) {
  double sum = 0.0;
  for (std::size_t j = 0; j < lattice.rows(); ++j) {
    for (std::size_t i = 0; i < lattice.columns(); ++i)
      sum += lattice.area(i, j) * static_cast<double>(value(lattice.index(i, j)));
  }
  return sum;
}

TEST(Blocks, OfLevelZeroAreTheCells) {
  std::mt19937 random = seededGenerator();
  const Grid grid = randomGrid(random);
  const Lattice lattice = blocksOf(grid, 0);
  ASSERT_EQ(lattice.cells(), grid.cells());
  for (int i = 0; i < grid.columns; ++i) EXPECT_EQ(lattice.x[static_cast<std::size_t>(i)], grid.x(i));
  for (int j = 0; j < grid.rows; ++j) EXPECT_EQ(lattice.y[static_cast<std::size_t>(j)], grid.y(j));
  const Fields fields = randomLoads(random, grid);
  const Fields same = blockMeans(grid, fields, 0);
  EXPECT_TRUE(sameBits(same.bed, fields.bed));
  EXPECT_TRUE(sameBits(same.depth, fields.depth));
  EXPECT_TRUE(sameBits(same.load, fields.load));
}

TEST(Blocks, CoverTheMapOnce) {
  std::mt19937 random = seededGenerator();
  const Grid grid = randomGrid(random);
  const double spacing = static_cast<double>(grid.spacing);
  for (int level = 0; level < 9; ++level) {
    const Lattice lattice = blocksOf(grid, level);
    double edge = grid.origin_x;
    for (std::size_t i = 0; i < lattice.columns(); ++i) {
      EXPECT_NEAR(lattice.x[i], edge + 0.5 * lattice.width[i], 1e-9);
      edge += lattice.width[i];
      const bool last = i + 1 == lattice.columns();
      EXPECT_LE(lattice.width[i], (1 << level) * spacing);
      EXPECT_TRUE(last || lattice.width[i] == (1 << level) * spacing);
    }
    EXPECT_NEAR(edge, grid.origin_x + grid.columns * spacing, 1e-9);
    EXPECT_NEAR(integral(lattice, [](std::size_t) { return 1.0; }),
                static_cast<double>(grid.cells()) * grid.cellArea(), 1e-9);
  }
}

TEST(Blocks, KeepVolumes) {
  std::mt19937 random = seededGenerator();
  const Grid grid = randomGrid(random);
  const Fields fields = randomLoads(random, grid);
  const Lattice cells = blocksOf(grid, 0);
  const double size = static_cast<double>(grid.cells()) * grid.cellArea();
  for (int level = 1; level < 9; ++level) {
    const Lattice lattice = blocksOf(grid, level);
    const Fields means = blockMeans(grid, fields, level);
    for (const auto values : {&Fields::bed, &Fields::depth, &Fields::load}) {
      EXPECT_NEAR(integral(lattice, [&](std::size_t k) { return (means.*values)[k]; }),
                  integral(cells, [&](std::size_t k) { return (fields.*values)[k]; }), 2e-7 * size);
    }
    const auto moment = [](const Fields& f) {
      return [&f](std::size_t k) {
        return static_cast<double>(f.load[k]) * static_cast<double>(f.load_elevation[k]);
      };
    };
    EXPECT_NEAR(integral(lattice, moment(means)), integral(cells, moment(fields)), 1e-6 * size);
  }
}

TEST(Blocks, OfTheFinestLevelAreAsManyAsMayBe) {
  std::mt19937 random = seededGenerator();
  const Grid grid = randomGrid(random);
  const std::size_t most = 1 + random() % (2 * grid.cells());
  const int level = finestLevel(grid, most);
  EXPECT_LE(blocksOf(grid, level).cells(), most);
  EXPECT_TRUE(level == 0 || blocksOf(grid, level - 1).cells() > most);
}

}  // namespace
}  // namespace shallow_sand
