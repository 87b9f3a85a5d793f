#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "shallow_sand/device/window.h"

namespace shallow_sand {

/// The part of a field of the grid that lies in a window, row-major like the field.
inline std::vector<float> partOf(const std::vector<float>& field, const Window& window, const Grid& grid) {
  std::vector<float> part;
  for (int j = window.row_begin; j < window.row_end; ++j) {
    const auto row = field.begin() + static_cast<std::ptrdiff_t>(grid.index(window.column_begin, j));
    part.insert(part.end(), row, row + window.columns());
  }
  return part;
}

/// Puts such a part back where it was.
inline void putPart(const std::vector<float>& part, const Window& window, const Grid& grid,
                    std::vector<float>& field) {
  auto row = part.begin();
  for (int j = window.row_begin; j < window.row_end; ++j, row += window.columns())
    std::copy_n(row, window.columns(),
                field.begin() + static_cast<std::ptrdiff_t>(grid.index(window.column_begin, j)));
}

}  // namespace shallow_sand
