#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "shallow_sand/device/window.h"

namespace shallow_sand {

/// Some cells of a window, one bit each.
class CellMask {
 public:
  /// None.
  explicit CellMask(const Window& window)
      : window_(window),
        words_((window.empty() ? 0 : window.columns() + kBits - 1) / kBits),
        bits_(static_cast<std::size_t>(words_) * (window.empty() ? 0 : window.rows()), 0) {}

  const Window& window() const { return window_; }

  /// Bits of different rows may be set at once by different threads.
  void set(int i, int j) {
    const int k = i - window_.column_begin;
    row(j)[k / kBits] |= std::uint64_t{1} << k % kBits;
  }

  /// These cells, and those of the window that lie beside one of them.
  CellMask grown() const {
    CellMask grown(window_);
    for (int j = window_.row_begin; j < window_.row_end; ++j) {
      std::uint64_t* out = grown.row(j);
      for (int w = 0; w < words_; ++w) {
        const std::uint64_t west = w > 0 ? row(j)[w - 1] >> (kBits - 1) : 0;
        const std::uint64_t east = w + 1 < words_ ? row(j)[w + 1] << (kBits - 1) : 0;
        const std::uint64_t south = j > window_.row_begin ? row(j - 1)[w] : 0;
        const std::uint64_t north = j + 1 < window_.row_end ? row(j + 1)[w] : 0;
        const std::uint64_t own = row(j)[w];
        out[w] = own | own << 1 | own >> 1 | west | east | south | north;
      }
      // What grew over the window's last column.
      if (window_.columns() % kBits != 0)
        out[words_ - 1] &= (std::uint64_t{1} << window_.columns() % kBits) - 1;
    }
    return grown;
  }

  /// Calls function(i, j) for the cells of a row, from west to east.
  template <class Function>
  void forEachInRow(int j, const Function& function) const {
    for (int w = 0; w < words_; ++w) {
      for (std::uint64_t left = row(j)[w]; left != 0; left &= left - 1)
        function(window_.column_begin + w * kBits + __builtin_ctzll(left), j);
    }
  }

 private:
  static constexpr int kBits = 64;

  std::uint64_t* row(int j) {
    return bits_.data() + static_cast<std::size_t>(j - window_.row_begin) * words_;
  }
  const std::uint64_t* row(int j) const {
    return bits_.data() + static_cast<std::size_t>(j - window_.row_begin) * words_;
  }

  Window window_;
  int words_;  // of a row
  std::vector<std::uint64_t> bits_;
};

}  // namespace shallow_sand
