#pragma once

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

  SHALLOW_SAND_HOST_DEVICE int columns() const { return column_end - column_begin; }
  SHALLOW_SAND_HOST_DEVICE int rows() const { return row_end - row_begin; }
  bool empty() const { return columns() <= 0 || rows() <= 0; }

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
  Window overlap(const Window& other) const {
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
