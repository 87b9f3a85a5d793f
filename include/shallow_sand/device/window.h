#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "shallow_sand/core/grid.h"

namespace shallow_sand {

/// A rectangle of cells: columns [column_begin, column_end), rows [row_begin, row_end).
struct Window {
  int column_begin = 0;
  int row_begin = 0;
  int column_end = 0;
  int row_end = 0;

  static Window all(const Grid& grid) { return {0, 0, grid.columns, grid.rows}; }
  /// `count` cells in one column, for work that has one index.
  static Window line(int count) { return {0, 0, 1, count}; }

  /// Cells whose centres may lie between these places, which are relative to the corner of cell (0, 0). [m]
  static Window around(double low_x, double low_y, double high_x, double high_y, const Grid& grid) {
    const double spacing = static_cast<double>(grid.spacing);
    const auto cell = [&](double position, int count) {
      return static_cast<int>(std::clamp(std::floor(position / spacing), 0.0, static_cast<double>(count)));
    };
    return {cell(low_x, grid.columns), cell(low_y, grid.rows), cell(high_x + spacing, grid.columns),
            cell(high_y + spacing, grid.rows)};
  }

  bool operator==(const Window& other) const {
    return column_begin == other.column_begin && row_begin == other.row_begin &&
           column_end == other.column_end && row_end == other.row_end;
  }

  SHALLOW_SAND_HOST_DEVICE int columns() const { return column_end - column_begin; }
  SHALLOW_SAND_HOST_DEVICE int rows() const { return row_end - row_begin; }
  SHALLOW_SAND_HOST_DEVICE bool holds(int i, int j) const {
    return i >= column_begin && i < column_end && j >= row_begin && j < row_end;
  }
  std::size_t cells() const { return static_cast<std::size_t>(columns()) * static_cast<std::size_t>(rows()); }
  SHALLOW_SAND_HOST_DEVICE bool empty() const { return columns() <= 0 || rows() <= 0; }

  /// Whether any cell is in one of the windows, too.
  bool overlapsAny(const std::vector<Window>& windows) const {
    return std::any_of(windows.begin(), windows.end(),
                       [&](const Window& window) { return !overlap(window).empty(); });
  }

  /// The smallest rectangle that holds both.
  Window united(const Window& other) const {
    if (empty()) return other;
    if (other.empty()) return *this;
    return {column_begin < other.column_begin ? column_begin : other.column_begin,
            row_begin < other.row_begin ? row_begin : other.row_begin,
            column_end > other.column_end ? column_end : other.column_end,
            row_end > other.row_end ? row_end : other.row_end};
  }
  /// The cells that are in both; empty if there are none.
  SHALLOW_SAND_HOST_DEVICE Window overlap(const Window& other) const {
    return {column_begin > other.column_begin ? column_begin : other.column_begin,
            row_begin > other.row_begin ? row_begin : other.row_begin,
            column_end < other.column_end ? column_end : other.column_end,
            row_end < other.row_end ? row_end : other.row_end};
  }
  /// Grown by `margin` cells on every side, but not beyond the grid.
  Window grown(int margin, const Grid& grid) const {
    if (empty()) return *this;
    return {column_begin > margin ? column_begin - margin : 0, row_begin > margin ? row_begin - margin : 0,
            column_end < grid.columns - margin ? column_end + margin : grid.columns,
            row_end < grid.rows - margin ? row_end + margin : grid.rows};
  }
};

}  // namespace shallow_sand
