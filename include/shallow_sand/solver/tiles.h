#pragma once

#include <cstdint>
#include <vector>

#include "shallow_sand/core/grid.h"
#include "shallow_sand/device/window.h"

namespace shallow_sand {

/// What a step found in a tile. Motion is anything that keeps a cell from being the same after every step,
/// however long: momentum before or after it, or sand that crosses one of its faces.
struct TileActivity {
  bool inside;  ///< motion in any cell
  bool west;    ///< motion within the reach of a step from the tile's western side
  bool east;
  bool south;
  bool north;
  float speed;  ///< largest signal speed before the step [m/s]
};

/// Which tiles of the map have to be stepped. A tile in which nothing moves, and beside which nothing moves,
/// would not change in any bit: it sleeps until a neighbour moves or somebody touches it.
class Tiles {
 public:
  static constexpr int kColumns = 32;
  static constexpr int kRows = 8;
  /// How many cells away a cell can feel another in one step; less than a tile is wide.
  static constexpr int kReach = 2;

  /// All tiles are due.
  explicit Tiles(const Grid& grid);

  /// The cells of the window have changed, or may change in ways that a step does not see.
  void touch(const Window& cells);
  /// Whether any cell of the window is in a tile that is due.
  bool isDue(const Window& cells) const;

  /// Rectangles of whole tiles that hold all tiles that are due and no other, at most `widest` columns and
  /// `highest` rows of cells each. Valid until the next call.
  const std::vector<Window>& due(int widest, int highest);

  Window cellsOf(int tile_column, int tile_row) const;
  /// Tile of a cell's column, or row.
  int tileOfColumn(int i) const { return i / kColumns < tile_columns_ ? i / kColumns : tile_columns_ - 1; }
  int tileOfRow(int j) const { return j / kRows < tile_rows_ ? j / kRows : tile_rows_ - 1; }

  /// Where a step writes what it found; several threads may, each for tiles of its own.
  TileActivity& activity(int tile_column, int tile_row) { return found_[index(tile_column, tile_row)]; }
  /// Largest signal speed of the map, from what was found in each tile the last time. [m/s]
  float speed();
  /// The step whose findings were written is done: the tiles that it kept awake are due next.
  void advance();

 private:
  static constexpr std::uint8_t kAsleep = 0;
  static constexpr std::uint8_t kDue = 1;
  static constexpr std::uint8_t kTaken = 2;  // due, and in a rectangle already

  std::size_t index(int tile_column, int tile_row) const {
    return static_cast<std::size_t>(tile_row) * tile_columns_ + tile_column;
  }
  std::uint8_t state(int tile_column, int tile_row) const { return states_[index(tile_column, tile_row)]; }
  void mark(const Window& tiles, std::uint8_t state);
  void wake(int tile_column, int tile_row);
  void wakeAround(int tile_column, int tile_row);
  Window takeRectangle(int tile_column, int tile_row, int columns, int rows);

  Grid grid_;
  int tile_columns_;
  int tile_rows_;
  std::vector<std::uint8_t> states_;
  Window bounds_;  // around the tiles that are due, in tiles
  std::vector<TileActivity> found_;
  std::vector<float> row_speed_;  // largest of each row of tiles
  float speed_ = 0.0f;
  std::vector<Window> rectangles_;  // in tiles
  std::vector<Window> cells_;       // the same in cells
};

}  // namespace shallow_sand
