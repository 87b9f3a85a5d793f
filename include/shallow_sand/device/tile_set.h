#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "shallow_sand/device/window.h"

namespace shallow_sand {

/// Some of the tiles into which a grid is cut; those at its far sides may be smaller.
class TileSet {
 public:
  /// None. @param tile_columns, tile_rows size of a tile in cells
  TileSet(const Grid& grid, int tile_columns, int tile_rows);

  /// Adds all tiles that hold a cell of the window.
  void add(const Window& cells);
  bool empty() const { return bounds_.empty(); }
  /// Rectangles of whole tiles that hold all tiles of the set and no other, at most so many tiles wide and
  /// high; in cells. The set is empty then.
  std::vector<Window> take(int widest = std::numeric_limits<int>::max(),
                           int highest = std::numeric_limits<int>::max());

 private:
  std::uint8_t& at(int tile_column, int tile_row) {
    return holds_[static_cast<std::size_t>(tile_row) * static_cast<std::size_t>(across_) +
                  static_cast<std::size_t>(tile_column)];
  }
  Window takeRectangle(int tile_column, int tile_row, int widest, int highest);

  Grid grid_;
  int tile_columns_;
  int tile_rows_;
  int across_;
  std::vector<std::uint8_t> holds_;
  Window bounds_;  // around the tiles of the set, in tiles
};

}  // namespace shallow_sand
