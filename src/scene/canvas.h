#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace shallow_sand {

/// Red, green, blue, each from 0 to 1.
using Colour = Eigen::Vector3f;

/// A picture in memory; pixel (0, 0) is the top left one, positions are in pixels.
class Canvas {
 public:
  Canvas(int width, int height, const Colour& background);

  int width() const { return width_; }
  int height() const { return height_; }
  Colour& at(int x, int y) { return pixels_[static_cast<std::size_t>(y) * width_ + x]; }

  void fillRectangle(int left, int top, int width, int height, const Colour& colour);
  /// A smooth line of `thickness` pixels.
  void drawLine(const Eigen::Vector2f& from, const Eigen::Vector2f& to, float thickness,
                const Colour& colour);
  /// Digits, the point and "m"; others are left blank. Letters are 3 by 5 squares of `size` pixels, one
  /// square apart.
  void drawText(const std::string& text, int left, int top, int size, const Colour& colour);
  static int textWidth(const std::string& text, int size);
  static int textHeight(int size);

  /// @throws std::runtime_error naming the file
  void writePng(const std::string& path) const;

 private:
  int width_;
  int height_;
  std::vector<Colour> pixels_;
};

}  // namespace shallow_sand
