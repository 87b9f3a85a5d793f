#include <gtest/gtest.h>

#include "random_fields.h"
#include "random_seed.h"
#include "shallow_sand/device/tile_set.h"

namespace shallow_sand {
namespace {

Grid randomGrid(std::mt19937& random) {
  Grid grid;
  grid.columns = randomCount(random, 1, 150);
  grid.rows = randomCount(random, 1, 150);
  grid.spacing = 1.0f;
  return grid;
}

TEST(TileSet, RectanglesHoldTheTilesThatWereAddedAndNoOther) {
  std::mt19937 random = seededGenerator();
  for (int run = 0; run < 200; ++run) {
    const Grid grid = randomGrid(random);
    const Size tile{randomCount(random, 1, 40), randomCount(random, 1, 40)};
    const Size most{randomCount(random, 1, 9), randomCount(random, 1, 9)};
    TileSet tiles(grid, tile.columns, tile.rows);
    EXPECT_TRUE(tiles.empty());
    // Twice: the set is empty after it was taken.
    for (int filling = 0; filling < 2; ++filling) {
      std::vector<int> expected(grid.cells(), 0);
      const int windows = randomCount(random, 0, 6);
      for (int k = 0; k < windows; ++k) {
        const int i = randomCount(random, 0, grid.columns - 1);
        const int j = randomCount(random, 0, grid.rows - 1);
        const Window window{i, j, randomCount(random, i, grid.columns), randomCount(random, j, grid.rows)};
        tiles.add(window);
        for (std::size_t cell = 0; cell < grid.cells(); ++cell) {
          const int column = static_cast<int>(cell) % grid.columns / tile.columns * tile.columns;
          const int row = static_cast<int>(cell) / grid.columns / tile.rows * tile.rows;
          const Window own{column, row, column + tile.columns, row + tile.rows};
          if (!window.empty() && !own.overlap(window).empty()) expected[cell] = 1;
        }
      }
      std::vector<int> held(grid.cells(), 0);
      for (const Window& cells : tiles.take(most.columns, most.rows)) {
        EXPECT_FALSE(cells.empty());
        EXPECT_LE(cells.columns(), most.columns * tile.columns);
        EXPECT_LE(cells.rows(), most.rows * tile.rows);
        for (int j = cells.row_begin; j < cells.row_end; ++j) {
          for (int i = cells.column_begin; i < cells.column_end; ++i) ++held.at(grid.index(i, j));
        }
      }
      ASSERT_EQ(held, expected) << "run " << run;
      EXPECT_TRUE(tiles.empty());
    }
  }
}

}  // namespace
}  // namespace shallow_sand
