#pragma once

#include <QImage>

namespace shallow_sand {

/// Shades of the sand's colour: what light does to it keeps the order of red, green and blue, and not much
/// more than their ratios.
inline bool isSand(QRgb pixel) {
  const int red = qRed(pixel);
  const int green = qGreen(pixel);
  const int blue = qBlue(pixel);
  return red > 30 && red - green > 0.08 * red && green - blue > 0.08 * red && red - green < 0.35 * red &&
         blue > 0.4 * red;
}

/// From 0 to 1.
inline double shareOfSand(const QImage& picture) {
  int sand = 0;
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) sand += isSand(picture.pixel(x, y)) ? 1 : 0;
  }
  return static_cast<double>(sand) / picture.width() / picture.height();
}

}  // namespace shallow_sand
