#pragma once

#include <vector>

namespace shallow_sand {

/// The pixels that a cell gets its number from, along one axis. Along two axes weights multiply.
struct PixelShare {
  int first = 0;  ///< number of a pixel
  int count = 0;  ///< of pixels from it on; 0: the cell's centre is not on the image
  double first_weight = 1.0;
  double last_weight = 1.0;

  /// Those between the first and the last have weight 1.
  double weight(int k) const { return k == 0 ? first_weight : k == count - 1 ? last_weight : 1.0; }
};

/// The cells of a row or column of a grid on an image. Where cells coincide with pixels, each gets its own;
/// where they are longer than pixels, those it covers, by how much it covers; else the two whose centres are
/// next to its own, which is linear between these.
/// @param cells how many there are
/// @param start where the first one begins, in pixels from the edge of the image
/// @param step from one cell to the next, in pixels; negative when they run against the pixels
/// @param pixels how many there are
std::vector<PixelShare> pixelShares(int cells, double start, double step, int pixels);

}  // namespace shallow_sand
