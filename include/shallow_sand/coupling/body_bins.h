#pragma once

#include <cstdint>

#include "shallow_sand/coupling/body_view.h"
#include "shallow_sand/device/window.h"

namespace shallow_sand {

/// Bodies at one instant, and which of them may touch which columns of a window.
struct BodyBins {
  static constexpr int kSize = 16;  ///< columns and rows of cells of a bin

  const BodyView* bodies;
  const int* first;    ///< for each bin, row-major from the window's corner, and one more: start in `members`
  const int* members;  ///< numbers of bodies, ascending within a bin
  Window window;
  int across;  ///< bins along x
  /// 1 for bodies that are left out, for they are far from sand; null if there are none such.
  const std::uint8_t* apart = nullptr;

  SHALLOW_SAND_HOST_DEVICE int binOf(int i, int j) const {
    return (j - window.row_begin) / kSize * across + (i - window.column_begin) / kSize;
  }
  int count() const { return across * ((window.rows() + kSize - 1) / kSize); }
  Window cellsOf(int bin) const {
    const int i = window.column_begin + bin % across * kSize;
    const int j = window.row_begin + bin / across * kSize;
    return Window{i, j, i + kSize, j + kSize}.overlap(window);
  }
};

}  // namespace shallow_sand
