#include "shallow_sand/device/tile_set.h"

#include <algorithm>

namespace shallow_sand {

namespace {

int tilesAlong(int cells, int length) { return (cells + length - 1) / length; }

}  // namespace

TileSet::TileSet(const Grid& grid, int tile_columns, int tile_rows)
    : grid_(grid),
      tile_columns_(tile_columns),
      tile_rows_(tile_rows),
      across_(tilesAlong(grid.columns, tile_columns)),
      holds_(static_cast<std::size_t>(across_) * static_cast<std::size_t>(tilesAlong(grid.rows, tile_rows)),
             0) {}

void TileSet::add(const Window& cells) {
  if (cells.empty()) return;
  const Window tiles{cells.column_begin / tile_columns_, cells.row_begin / tile_rows_,
                     tilesAlong(cells.column_end, tile_columns_), tilesAlong(cells.row_end, tile_rows_)};
  for (int row = tiles.row_begin; row < tiles.row_end; ++row) {
    std::fill_n(&at(tiles.column_begin, row), tiles.columns(), std::uint8_t{1});
  }
  bounds_ = bounds_.united(tiles);
}

std::vector<Window> TileSet::take(int widest, int highest) {
  std::vector<Window> rectangles;
  for (int row = bounds_.row_begin; row < bounds_.row_end; ++row) {
    for (int column = bounds_.column_begin; column < bounds_.column_end; ++column) {
      if (at(column, row) != 0) rectangles.push_back(takeRectangle(column, row, widest, highest));
    }
  }
  bounds_ = Window{};
  return rectangles;
}

Window TileSet::takeRectangle(int tile_column, int tile_row, int widest, int highest) {
  const auto rowIsIn = [&](int row, int end) {
    for (int column = tile_column; column < end; ++column) {
      if (at(column, row) == 0) return false;
    }
    return true;
  };
  int column_end = tile_column + 1;
  while (column_end < bounds_.column_end && column_end - tile_column < widest &&
         at(column_end, tile_row) != 0)
    ++column_end;
  int row_end = tile_row + 1;
  while (row_end < bounds_.row_end && row_end - tile_row < highest && rowIsIn(row_end, column_end)) ++row_end;
  for (int row = tile_row; row < row_end; ++row) {
    std::fill_n(&at(tile_column, row), column_end - tile_column, std::uint8_t{0});
  }
  return {tile_column * tile_columns_, tile_row * tile_rows_,
          std::min(column_end * tile_columns_, grid_.columns), std::min(row_end * tile_rows_, grid_.rows)};
}

}  // namespace shallow_sand
