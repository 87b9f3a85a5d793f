#pragma once

#include <vector>

#include "shallow_sand/core/fields.h"
#include "shallow_sand/device/window.h"

namespace shallow_sand {

/// New values of some cells, to be carried to a copy of the fields in another thread.
struct FieldsChange {
  std::vector<Window> windows;  ///< that do not overlap
  /// Of the cells of each window, row by row, one window after the other. No momenta of loads; the bed only
  /// where all cells are there.
  Fields values;
};

/// Adds the values of a window's cells to a list, row by row. @param from one value a cell of the grid
void appendCells(const std::vector<float>& from, const Window& window, const Grid& grid,
                 std::vector<float>& to);

/// @param windows that do not overlap
/// @param reused a change that nobody needs any more: memory that is new is dear
FieldsChange changeOf(const Fields& fields, std::vector<Window> windows, const Grid& grid,
                      FieldsChange reused = {});

/// The change holds every cell of the map.
bool isWhole(const FieldsChange& change, const Grid& grid);

/// Brings a copy up to date. The first change that it takes must be whole.
void apply(const FieldsChange& change, const Grid& grid, Fields& copy);

}  // namespace shallow_sand
