#include "shallow_sand/ros/fields_change.h"

#include <algorithm>
#include <utility>

namespace shallow_sand {
namespace {

using Member = std::vector<float> Fields::*;

/// That follow the sand; the bed does not.
constexpr Member kCarried[] = {&Fields::depth, &Fields::momentum_x, &Fields::momentum_y, &Fields::load,
                               &Fields::load_elevation};

std::size_t cellsOf(const std::vector<Window>& windows) {
  std::size_t cells = 0;
  for (const Window& window : windows) cells += window.cells();
  return cells;
}

}  // namespace

void appendCells(const std::vector<float>& from, const Window& window, const Grid& grid,
                 std::vector<float>& to) {
  for (int j = window.row_begin; j < window.row_end; ++j) {
    const auto row = from.begin() + static_cast<std::ptrdiff_t>(grid.index(window.column_begin, j));
    to.insert(to.end(), row, row + window.columns());
  }
}

bool isWhole(const FieldsChange& change, const Grid& grid) { return cellsOf(change.windows) == grid.cells(); }

FieldsChange changeOf(const Fields& fields, std::vector<Window> windows, const Grid& grid,
                      FieldsChange reused) {
  FieldsChange change = std::move(reused);
  const std::size_t cells = cellsOf(windows);
  // Then a list of values is that of the map.
  if (cells == grid.cells()) windows = {Window::all(grid)};
  change.windows = std::move(windows);
  change.values.bed.clear();
  if (cells == grid.cells()) change.values.bed = fields.bed;
  for (const Member member : kCarried) {
    const std::vector<float>& from = fields.*member;
    std::vector<float>& to = change.values.*member;
    to.clear();
    if (from.empty()) continue;
    to.reserve(cells);
    for (const Window& window : change.windows) appendCells(from, window, grid, to);
  }
  return change;
}

void apply(const FieldsChange& change, const Grid& grid, Fields& copy) {
  if (isWhole(change, grid)) {
    copy = change.values;
    return;
  }
  for (const Member member : kCarried) {
    if ((change.values.*member).empty()) continue;
    auto from = (change.values.*member).begin();
    for (const Window& window : change.windows) {
      for (int j = window.row_begin; j < window.row_end; ++j, from += window.columns()) {
        std::copy_n(from, window.columns(),
                    (copy.*member).begin() + static_cast<std::ptrdiff_t>(grid.index(window.column_begin, j)));
      }
    }
  }
}

}  // namespace shallow_sand
