#include "canvas.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>

#include "gdal_support.h"
#include "shallow_sand/core/replace_file.h"

namespace shallow_sand {
namespace {

constexpr int kLetterWidth = 5;
constexpr int kLetterHeight = 7;

/// Rows from the top, the leftmost square in the highest of five bits.
using Letter = std::array<std::uint8_t, kLetterHeight>;
const std::map<char, Letter>& letters() {
  static const std::map<char, Letter> table{
      {'0', {14, 17, 17, 17, 17, 17, 14}}, {'1', {4, 12, 4, 4, 4, 4, 14}}, {'2', {14, 17, 1, 2, 4, 8, 31}},
      {'5', {31, 16, 30, 1, 1, 17, 14}},   {'.', {0, 0, 0, 0, 0, 12, 12}}, {'m', {0, 0, 26, 21, 21, 21, 21}}};
  return table;
}

/// Distance of a point to the segment from `a` to `b`.
float distanceToSegment(const Eigen::Vector2f& point, const Eigen::Vector2f& a, const Eigen::Vector2f& b) {
  const Eigen::Vector2f along = b - a;
  const float length_squared = std::max(along.squaredNorm(), 1e-6f);
  const float t = std::clamp((point - a).dot(along) / length_squared, 0.0f, 1.0f);
  return (point - a - t * along).norm();
}

std::uint8_t byteFrom(float value) {
  return static_cast<std::uint8_t>(std::clamp(value, 0.0f, 1.0f) * 255.0f + 0.5f);
}

}  // namespace

Canvas::Canvas(int width, int height, const Colour& background)
    : width_(width), height_(height), pixels_(static_cast<std::size_t>(width) * height, background) {}

void Canvas::fillRectangle(int left, int top, int width, int height, const Colour& colour) {
  for (int y = std::max(0, top); y < std::min(height_, top + height); ++y) {
    for (int x = std::max(0, left); x < std::min(width_, left + width); ++x) {
      at(x, y) = colour;
    }
  }
}

void Canvas::drawLine(const Eigen::Vector2f& from, const Eigen::Vector2f& to, float thickness,
                      const Colour& colour) {
  const float reach = 0.5f * thickness + 1.0f;
  const Eigen::Vector2f canvas_size(static_cast<float>(width_ - 1), static_cast<float>(height_ - 1));
  const Eigen::Vector2f low = (from.cwiseMin(to).array() - reach).matrix().cwiseMax(0.0f);
  const Eigen::Vector2f high = (from.cwiseMax(to).array() + reach).matrix().cwiseMin(canvas_size);
  for (int y = static_cast<int>(low.y()); y <= high.y(); ++y) {
    for (int x = static_cast<int>(low.x()); x <= high.x(); ++x) {
      const float distance = distanceToSegment(Eigen::Vector2f(x + 0.5f, y + 0.5f), from, to);
      const float cover = std::clamp(0.5f * thickness + 0.5f - distance, 0.0f, 1.0f);
      at(x, y) += cover * (colour - at(x, y));
    }
  }
}

void Canvas::drawText(const std::string& text, int left, int top, int size, const Colour& colour) {
  for (const char c : text) {
    const auto letter = letters().find(c);
    for (int row = 0; letter != letters().end() && row < kLetterHeight; ++row) {
      for (int column = 0; column < kLetterWidth; ++column) {
        if ((letter->second[static_cast<std::size_t>(row)] >> (kLetterWidth - 1 - column)) & 1) {
          fillRectangle(left + column * size, top + row * size, size, size, colour);
        }
      }
    }
    left += (kLetterWidth + 1) * size;
  }
}

int Canvas::textWidth(const std::string& text, int size) {
  return (static_cast<int>(text.size()) * (kLetterWidth + 1) - 1) * size;
}

int Canvas::textHeight(int size) { return kLetterHeight * size; }

void Canvas::writePng(const std::string& path) const {
  const QuietGdal quiet;
  DatasetPointer memory(gdalDriver("MEM", path).Create("", width_, height_, 3, GDT_Byte, nullptr));
  requireGdal(memory != nullptr, path);
  std::vector<std::uint8_t> bytes(pixels_.size());
  for (int channel = 0; channel < 3; ++channel) {
    std::transform(pixels_.begin(), pixels_.end(), bytes.begin(),
                   [channel](const Colour& colour) { return byteFrom(colour[channel]); });
    requireGdal(memory->GetRasterBand(channel + 1)
                        ->RasterIO(GF_Write, 0, 0, width_, height_, bytes.data(), width_, height_, GDT_Byte,
                                   0, 0, nullptr) == CE_None,
                path);
  }
  replaceFile(path, [&](const std::filesystem::path& part) {
    const DatasetPointer png(
        gdalDriver("PNG", path).CreateCopy(part.c_str(), memory.get(), 0, nullptr, nullptr, nullptr));
    requireGdal(png != nullptr, path);
  });
}

}  // namespace shallow_sand
