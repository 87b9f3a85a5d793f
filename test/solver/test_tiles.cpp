#include <gtest/gtest.h>

#include "random_seed.h"
#include "shallow_sand/solver/tiles.h"

namespace shallow_sand {
namespace {

int between(std::mt19937& random, int least, int most) {
  return least + static_cast<int>(random() % static_cast<unsigned>(most - least + 1));
}

Grid randomGrid(std::mt19937& random) {
  Grid grid;
  grid.columns = between(random, 1, random() % 2 == 0 ? 70 : 700);
  grid.rows = between(random, 1, random() % 2 == 0 ? 40 : 300);
  grid.spacing = 0.1f;
  return grid;
}

Window randomWindow(std::mt19937& random, const Grid& grid) {
  Window window;
  window.column_begin = between(random, 0, grid.columns - 1);
  window.row_begin = between(random, 0, grid.rows - 1);
  window.column_end = std::min(grid.columns, window.column_begin + between(random, 1, 80));
  window.row_end = std::min(grid.rows, window.row_begin + between(random, 1, 40));
  return window;
}

int tileColumns(const Grid& grid, const Tiles& tiles) { return tiles.tileOfColumn(grid.columns - 1) + 1; }
int tileRows(const Grid& grid, const Tiles& tiles) { return tiles.tileOfRow(grid.rows - 1) + 1; }

/// How often each cell is in a rectangle.
std::vector<int> cover(const Grid& grid, const std::vector<Window>& rectangles) {
  std::vector<int> count(grid.cells(), 0);
  for (const Window& cells : rectangles) {
    for (int j = cells.row_begin; j < cells.row_end; ++j) {
      for (int i = cells.column_begin; i < cells.column_end; ++i) count[grid.index(i, j)] += 1;
    }
  }
  return count;
}

/// All tiles asleep.
Tiles sleepingTiles(const Grid& grid) {
  Tiles tiles(grid);
  tiles.due(Tiles::kColumns, Tiles::kRows);
  tiles.advance();
  return tiles;
}

/// Cells of the tiles that hold a cell of the set.
std::vector<int> wholeTiles(const Grid& grid, const Tiles& tiles, const std::vector<int>& cells) {
  std::vector<int> result(grid.cells(), 0);
  for (int row = 0; row < tileRows(grid, tiles); ++row) {
    for (int column = 0; column < tileColumns(grid, tiles); ++column) {
      const Window tile = tiles.cellsOf(column, row);
      bool held = false;
      for (int j = tile.row_begin; j < tile.row_end; ++j) {
        for (int i = tile.column_begin; i < tile.column_end; ++i) held = held || cells[grid.index(i, j)] > 0;
      }
      for (int j = tile.row_begin; held && j < tile.row_end; ++j) {
        for (int i = tile.column_begin; i < tile.column_end; ++i) result[grid.index(i, j)] = 1;
      }
    }
  }
  return result;
}

TEST(Tiles, EachCellIsInTheTileThatSaysSo) {
  std::mt19937 random = seededGenerator();
  for (int number = 0; number < 50; ++number) {
    const Grid grid = randomGrid(random);
    const Tiles tiles(grid);
    std::vector<Window> all;
    for (int row = 0; row < tileRows(grid, tiles); ++row) {
      for (int column = 0; column < tileColumns(grid, tiles); ++column) {
        const Window tile = tiles.cellsOf(column, row);
        all.push_back(tile);
        EXPECT_EQ(tiles.tileOfColumn(tile.column_begin), column);
        EXPECT_EQ(tiles.tileOfColumn(tile.column_end - 1), column);
        EXPECT_EQ(tiles.tileOfRow(tile.row_begin), row);
        EXPECT_EQ(tiles.tileOfRow(tile.row_end - 1), row);
        // A step that began in a tile must not reach past its neighbour.
        EXPECT_TRUE(tile.columns() >= std::min(Tiles::kReach, grid.columns));
        EXPECT_TRUE(tile.rows() >= std::min(Tiles::kReach, grid.rows));
      }
    }
    EXPECT_EQ(cover(grid, all), std::vector<int>(grid.cells(), 1));
  }
}

TEST(Tiles, AllAreDueAtFirstAndNoneOnceNothingMoves) {
  std::mt19937 random = seededGenerator();
  for (int number = 0; number < 50; ++number) {
    const Grid grid = randomGrid(random);
    Tiles tiles(grid);
    EXPECT_EQ(cover(grid, tiles.due(256, 64)), std::vector<int>(grid.cells(), 1));
    tiles.advance();
    EXPECT_TRUE(tiles.due(256, 64).empty());
  }
}

TEST(Tiles, RectanglesHoldWhatWasTouchedOnceAndNothingElse) {
  std::mt19937 random = seededGenerator();
  for (int number = 0; number < 200; ++number) {
    const Grid grid = randomGrid(random);
    SCOPED_TRACE(std::to_string(grid.columns) + " x " + std::to_string(grid.rows));
    Tiles tiles = sleepingTiles(grid);
    std::vector<Window> touched;
    for (int k = between(random, 0, 6); k > 0; --k) {
      const Window window = randomWindow(random, grid);
      tiles.touch(window);
      touched.push_back(window.grown(Tiles::kReach, grid));
    }
    const int widest = between(random, 1, 300);
    const int highest = between(random, 1, 100);
    const std::vector<Window> rectangles = tiles.due(widest, highest);
    EXPECT_EQ(cover(grid, rectangles), wholeTiles(grid, tiles, cover(grid, touched)));
    for (const Window& cells : rectangles) {
      // The last tile along a side takes the remainder.
      EXPECT_LT(cells.columns(), std::max(widest, Tiles::kColumns) + Tiles::kColumns);
      EXPECT_LT(cells.rows(), std::max(highest, Tiles::kRows) + Tiles::kRows);
    }
    // A step that was too long is computed again.
    EXPECT_EQ(cover(grid, tiles.due(widest, highest)), cover(grid, rectangles));
  }
}

/// The tiles that are due after a step that found this in one tile, and nothing elsewhere.
std::vector<int> dueAfter(const Grid& grid, int column, int row, const TileActivity& found) {
  Tiles tiles(grid);
  tiles.due(256, 64);
  tiles.activity(column, row) = found;
  tiles.advance();
  return cover(grid, tiles.due(256, 64));
}

TEST(Tiles, MotionNearASideWakesTheNeighbourThere) {
  std::mt19937 random = seededGenerator();
  for (int number = 0; number < 100; ++number) {
    Grid grid = randomGrid(random);
    const Tiles layout(grid);
    const int columns = tileColumns(grid, layout);
    const int rows = tileRows(grid, layout);
    const int column = between(random, 0, columns - 1);
    const int row = between(random, 0, rows - 1);
    const auto coin = [&] { return random() % 2 == 0; };
    const TileActivity found{true, coin(), coin(), coin(), coin(), 1.0f};
    std::vector<Window> expected{layout.cellsOf(column, row)};
    if (found.west && column > 0) expected.push_back(layout.cellsOf(column - 1, row));
    if (found.east && column < columns - 1) expected.push_back(layout.cellsOf(column + 1, row));
    if (found.south && row > 0) expected.push_back(layout.cellsOf(column, row - 1));
    if (found.north && row < rows - 1) expected.push_back(layout.cellsOf(column, row + 1));
    EXPECT_EQ(dueAfter(grid, column, row, found), cover(grid, expected));
  }
}

TEST(Tiles, SpeedIsTheLargestOfAllTilesAlsoOfThoseThatSleep) {
  std::mt19937 random = seededGenerator();
  for (int number = 0; number < 100; ++number) {
    const Grid grid = randomGrid(random);
    Tiles tiles(grid);
    const int columns = tileColumns(grid, tiles);
    const int rows = tileRows(grid, tiles);
    tiles.due(256, 64);
    std::vector<float> speeds(static_cast<std::size_t>(columns) * rows);
    for (int step = 0; step < 5; ++step) {
      for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
          float& speed = speeds[static_cast<std::size_t>(row) * columns + column];
          // Only the tiles that are due find anything; at first all are.
          if (step > 0 && (column != columns / 2 || row != rows / 2)) continue;
          speed = static_cast<float>(random() % 1000);
          tiles.activity(column, row) = {
              column == columns / 2 && row == rows / 2, false, false, false, false, speed};
        }
      }
      EXPECT_EQ(tiles.speed(), *std::max_element(speeds.begin(), speeds.end()));
      tiles.advance();
      tiles.due(256, 64);
    }
  }
}

}  // namespace
}  // namespace shallow_sand
