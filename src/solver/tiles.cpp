#include "shallow_sand/solver/tiles.h"

#include <algorithm>

namespace shallow_sand {

namespace {

/// Tiles along one side. The last one takes the remainder: none is narrower than the reach of a step.
int tilesAlong(int cells, int length) { return std::max(1, cells / length); }

}  // namespace

Tiles::Tiles(const Grid& grid)
    : grid_(grid),
      tile_columns_(tilesAlong(grid.columns, kColumns)),
      tile_rows_(tilesAlong(grid.rows, kRows)),
      states_(static_cast<std::size_t>(tile_columns_) * tile_rows_, kAsleep),
      found_(states_.size(), TileActivity{}),
      row_speed_(tile_rows_, 0.0f) {
  touch(Window::all(grid));
}

Window Tiles::cellsOf(int tile_column, int tile_row) const {
  return {tile_column * kColumns, tile_row * kRows,
          tile_column == tile_columns_ - 1 ? grid_.columns : (tile_column + 1) * kColumns,
          tile_row == tile_rows_ - 1 ? grid_.rows : (tile_row + 1) * kRows};
}

void Tiles::touch(const Window& cells) {
  if (cells.empty()) return;
  const Window reached = cells.grown(kReach, grid_);
  for (int row = tileOfRow(reached.row_begin); row <= tileOfRow(reached.row_end - 1); ++row) {
    for (int column = tileOfColumn(reached.column_begin); column <= tileOfColumn(reached.column_end - 1);
         ++column) {
      wake(column, row);
    }
  }
}

bool Tiles::isDue(const Window& cells) const {
  if (cells.empty()) return false;
  for (int row = tileOfRow(cells.row_begin); row <= tileOfRow(cells.row_end - 1); ++row) {
    for (int column = tileOfColumn(cells.column_begin); column <= tileOfColumn(cells.column_end - 1);
         ++column) {
      if (state(column, row) != kAsleep) return true;
    }
  }
  return false;
}

void Tiles::wake(int tile_column, int tile_row) {
  states_[index(tile_column, tile_row)] = kDue;
  bounds_ = bounds_.united({tile_column, tile_row, tile_column + 1, tile_row + 1});
}

const std::vector<Window>& Tiles::due(int widest, int highest) {
  const int columns = std::max(1, widest / kColumns);
  const int rows = std::max(1, highest / kRows);
  rectangles_.clear();
  for (int row = bounds_.row_begin; row < bounds_.row_end; ++row) {
    for (int column = bounds_.column_begin; column < bounds_.column_end; ++column) {
      if (state(column, row) == kDue) rectangles_.push_back(takeRectangle(column, row, columns, rows));
    }
  }
  for (const Window& tiles : rectangles_) mark(tiles, kDue);
  cells_.clear();
  for (const Window& tiles : rectangles_) {
    cells_.push_back(cellsOf(tiles.column_begin, tiles.row_begin)
                         .united(cellsOf(tiles.column_end - 1, tiles.row_end - 1)));
  }
  return cells_;
}

Window Tiles::takeRectangle(int tile_column, int tile_row, int columns, int rows) {
  const auto rowIsDue = [&](int row, int end) {
    for (int column = tile_column; column < end; ++column) {
      if (state(column, row) != kDue) return false;
    }
    return true;
  };
  int column_end = tile_column + 1;
  while (column_end < bounds_.column_end && column_end - tile_column < columns &&
         state(column_end, tile_row) == kDue)
    ++column_end;
  int row_end = tile_row + 1;
  while (row_end < bounds_.row_end && row_end - tile_row < rows && rowIsDue(row_end, column_end)) ++row_end;
  const Window tiles{tile_column, tile_row, column_end, row_end};
  mark(tiles, kTaken);
  return tiles;
}

void Tiles::mark(const Window& tiles, std::uint8_t state) {
  for (int row = tiles.row_begin; row < tiles.row_end; ++row) {
    std::fill(&states_[index(tiles.column_begin, row)],
              &states_[index(tiles.column_begin, row)] + tiles.columns(), state);
  }
}

float Tiles::speed() {
  if (bounds_.empty()) return speed_;
  for (int row = bounds_.row_begin; row < bounds_.row_end; ++row) {
    const TileActivity* tiles = &found_[index(0, row)];
    float fastest = 0.0f;
    for (int column = 0; column < tile_columns_; ++column) fastest = maximum(fastest, tiles[column].speed);
    row_speed_[row] = fastest;
  }
  speed_ = *std::max_element(row_speed_.begin(), row_speed_.end());
  return speed_;
}

void Tiles::advance() {
  for (const Window& tiles : rectangles_) mark(tiles, kAsleep);
  bounds_ = Window{};
  for (const Window& tiles : rectangles_) {
    for (int row = tiles.row_begin; row < tiles.row_end; ++row) {
      for (int column = tiles.column_begin; column < tiles.column_end; ++column) wakeAround(column, row);
    }
  }
  rectangles_.clear();
}

void Tiles::wakeAround(int tile_column, int tile_row) {
  const TileActivity& found = found_[index(tile_column, tile_row)];
  if (!found.inside) return;
  wake(tile_column, tile_row);
  if (found.west && tile_column > 0) wake(tile_column - 1, tile_row);
  if (found.east && tile_column < tile_columns_ - 1) wake(tile_column + 1, tile_row);
  if (found.south && tile_row > 0) wake(tile_column, tile_row - 1);
  if (found.north && tile_row < tile_rows_ - 1) wake(tile_column, tile_row + 1);
}

}  // namespace shallow_sand
