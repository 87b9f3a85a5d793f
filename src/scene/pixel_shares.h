#pragma once

#include <vector>

namespace shallow_sand {

/// The pixels that a cell gets its number from, along one axis. Along two axes shares multiply.
struct PixelShare {
  int first = 0;                ///< number of a pixel
  std::vector<double> weights;  ///< of it and those after it; none: the cell's centre is not on the image
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
