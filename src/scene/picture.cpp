#include "shallow_sand/scene/picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <sstream>

#include "canvas.h"
#include "gdal_support.h"
#include "raster.h"
#include "shallow_sand/surface/surface_colour.h"

namespace shallow_sand {
namespace {

constexpr int kBlur = 40;  ///< how far the surroundings of a pixel reach [pixels]
const Colour kPaper(0.96f, 0.94f, 0.90f);
const Colour kInk(0.20f, 0.15f, 0.11f);
const Colour kOutline(0.10f, 0.30f, 0.42f);

/// The layers that a pixel's colour comes from, all of the same size.
struct Relief {
  double pixel = 0.0;   ///< edge length of a pixel [m]
  Raster surface;       ///< elevation [m]
  Raster depth;         ///< of the sand [m]
  Raster shade;         ///< 0 dark to 1 bright
  Raster surroundings;  ///< mean elevation around a pixel [m]
};

Colour mix(const Colour& a, const Colour& b, float t) { return a + t * (b - a); }

float smoothStep(float low, float high, float value) {
  const float t = std::clamp((value - low) / (high - low), 0.0f, 1.0f);
  return t * t * (3.0f - 2.0f * t);
}

/// Value below which a share of `values` lies.
float quantile(std::vector<float> values, double share) {
  if (values.empty()) {
    return 0.0f;
  }
  const auto nth =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

/// Lifts gentle terrain: its steeper parts should look as steep as sand at its angle of repose. Piles and
/// ruts have such slopes themselves, whatever their size, and stay almost as they are.
double exaggerationFor(const Raster& surface, double pixel) {
  constexpr double kSlopeToShow = 0.75;
  std::vector<float> slopes;
  constexpr int kStride = 4;
  for (int y = 0; y + kStride < surface.height; y += kStride) {
    for (int x = 0; x + kStride < surface.width; x += kStride) {
      const float* here = surface.values.data() + static_cast<std::size_t>(y) * surface.width + x;
      slopes.push_back(std::hypot(here[kStride] - here[0], here[kStride * surface.width] - here[0]));
    }
  }
  const double steep = static_cast<double>(quantile(slopes, 0.98)) / (kStride * pixel);
  return std::clamp(kSlopeToShow / std::max(steep, 1e-6), 1.2, 4.0);
}

Relief makeRelief(const Grid& grid, const Fields& fields, const std::string& path) {
  const double scale = static_cast<double>(kPictureLongSide) / std::max(grid.columns, grid.rows);
  const int width = std::max(1, static_cast<int>(std::lround(grid.columns * scale)));
  const int height = std::max(1, static_cast<int>(std::lround(grid.rows * scale)));
  std::vector<float> surface(grid.cells());
  std::vector<float> depth(grid.cells());
  for (std::size_t k = 0; k < grid.cells(); ++k) {
    surface[k] = fields.surface(k);
    depth[k] = fields.allDepth(k);
  }

  Relief relief;
  relief.pixel = static_cast<double>(grid.spacing) / scale;
  relief.surface = resample(grid, surface, width, height, GRIORA_CubicSpline, path);
  relief.depth = resample(grid, depth, width, height, GRIORA_CubicSpline, path);
  relief.shade = hillshade(relief.surface, relief.pixel, exaggerationFor(relief.surface, relief.pixel), path);
  const Raster coarse =
      resample(relief.surface, std::max(1, width / kBlur), std::max(1, height / kBlur), GRIORA_Average, path);
  relief.surroundings = resample(coarse, width, height, GRIORA_CubicSpline, path);
  return relief;
}

/// Elevations between which the sand tones spread.
std::array<float, 2> toneRange(const Relief& relief, float bare_depth) {
  std::vector<float> elevations;
  for (std::size_t k = 0; k < relief.surface.values.size(); ++k) {
    if (relief.depth.values[k] > bare_depth) {
      elevations.push_back(relief.surface.values[k]);
    }
  }
  const float low = quantile(elevations, 0.01);
  const float high = quantile(elevations, 0.99);
  // Level sand gets the middle tone, not noise spread over all of them.
  const float least = static_cast<float>(0.06 * kPictureLongSide * relief.pixel);
  const float missing = std::max(0.0f, least - (high - low));
  return {low - 0.5f * missing, high + 0.5f * missing};
}

/// Dune tones from hollows to crests.
Colour sandTone(float t) {
  static const std::array<Colour, 4> ramp{Colour(0.70f, 0.51f, 0.35f), Colour(0.83f, 0.66f, 0.46f),
                                          Colour(0.92f, 0.78f, 0.58f), Colour(0.98f, 0.89f, 0.73f)};
  const float position = std::clamp(t, 0.0f, 1.0f) * static_cast<float>(ramp.size() - 1);
  const std::size_t k = std::min(static_cast<std::size_t>(position), ramp.size() - 2);
  return mix(ramp[k], ramp[k + 1], position - static_cast<float>(k));
}

/// Light on a pixel: warm in the sun, cool in the shade, and less of it in hollows.
Colour lightAt(const Relief& relief, std::size_t k) {
  static const Colour kShadow(0.38f, 0.35f, 0.42f);
  static const Colour kSun(1.14f, 1.12f, 1.07f);
  const float reach = static_cast<float>(kBlur * relief.pixel);
  const float height = (relief.surface.values[k] - relief.surroundings.values[k]) / reach;
  const float openness = std::clamp(1.0f + 0.6f * height, 0.7f, 1.06f);
  return openness * mix(kShadow, kSun, relief.shade.values[k]);
}

/// From -1 to 1, unlike that of any near pixel and the same in every run.
float grain(std::uint32_t x, std::uint32_t y) {
  std::uint32_t bits = x * 0x9E3779B1u ^ (y + 0x7F4A7C15u) * 0x85EBCA77u;
  bits = (bits ^ (bits >> 15)) * 0x2C1B3C6Du;
  bits = (bits ^ (bits >> 13)) * 0x297A2D39u;
  return static_cast<float>((bits ^ (bits >> 16)) & 0xFFFFu) / 32767.5f - 1.0f;
}

/// For each pixel the colour of the highest grain over it, and how high that is; grains are 2 Δl wide. [m]
struct GrainTones {
  std::vector<Colour> colour;
  std::vector<float> elevation;  ///< below everything where there is none

  bool covers(std::size_t pixel) const { return elevation[pixel] > -std::numeric_limits<float>::max(); }
};

GrainTones tonesOf(const GrainCloud& grains, const Grid& grid, const Relief& relief) {
  const int width = relief.surface.width;
  const int height = relief.surface.height;
  const std::size_t pixels = relief.surface.values.size();
  GrainTones tones{std::vector<Colour>(pixels, Colour::Zero()),
                   std::vector<float>(pixels, -std::numeric_limits<float>::max())};
  const double north = grid.origin_y + grid.rows * static_cast<double>(grid.spacing);
  const double radius = static_cast<double>(grains.spacing) / relief.pixel;
  const auto first = [&](double place) {
    return static_cast<int>(std::max(0.0, std::ceil(place - radius - 0.5)));
  };
  for (std::size_t k = 0; k < grains.points.size(); ++k) {
    const Eigen::Vector3d point = grains.points[k].cast<double>();
    const double x = (point.x() - grid.origin_x) / relief.pixel;
    const double y = (north - point.y()) / relief.pixel;
    for (int row = first(y); row < height && row + 0.5 <= y + radius; ++row) {
      for (int column = first(x); column < width && column + 0.5 <= x + radius; ++column) {
        const std::size_t pixel = static_cast<std::size_t>(row) * width + column;
        if (std::hypot(column + 0.5 - x, row + 0.5 - y) > radius) continue;
        if (grains.points[k].z() <= tones.elevation[pixel]) continue;
        tones.elevation[pixel] = grains.points[k].z();
        tones.colour[pixel] = grains.colors[k];
      }
    }
  }
  return tones;
}

void paintRelief(const Relief& relief, const GrainTones& grains, float bare_depth, Canvas& canvas) {
  static const Colour kRock(0.50f, 0.51f, 0.54f);
  const std::array<float, 2> range = toneRange(relief, bare_depth);
  for (int y = 0; y < relief.surface.height; ++y) {
    for (int x = 0; x < relief.surface.width; ++x) {
      const std::size_t k = static_cast<std::size_t>(y) * relief.surface.width + x;
      const Colour sand = grains.covers(k)
                              ? grains.colour[k]
                              : sandTone((relief.surface.values[k] - range[0]) / (range[1] - range[0]));
      const float covered = smoothStep(0.5f * bare_depth, 1.5f * bare_depth, relief.depth.values[k]);
      const Colour material = mix(kRock, sand, covered);
      const float rough = 1.0f + 0.03f * grain(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y));
      canvas.at(x + kPictureBorder, y + kPictureBorder) = rough * material.cwiseProduct(lightAt(relief, k));
    }
  }
}

void drawOutline(const Outline& outline, const Grid& grid, double pixel, Canvas& canvas) {
  const double north = grid.origin_y + grid.rows * static_cast<double>(grid.spacing);
  const auto place = [&](const Eigen::Vector2d& point) -> Eigen::Vector2f {
    const Eigen::Vector2d offset(point.x() - grid.origin_x, north - point.y());
    return (offset / pixel).cast<float>() + Eigen::Vector2f::Constant(kPictureBorder);
  };
  for (std::size_t k = 0; k < outline.size(); ++k) {
    canvas.drawLine(place(outline[k]), place(outline[(k + 1) % outline.size()]), 2.5f, kOutline);
  }
}

/// The longest of 1, 2 or 5 times a power of ten that is not above `length`.
double roundLength(double length) {
  const double power = std::pow(10.0, std::floor(std::log10(length)));
  const double first = length / power;
  return power * (first >= 5.0 ? 5.0 : first >= 2.0 ? 2.0 : 1.0);
}

/// A bar of a round length, with the length beside it, on a strip of paper in the lower left corner.
void drawScaleBar(double pixel, Canvas& canvas) {
  constexpr int kPad = 10;
  constexpr int kLetter = 3;
  const double length = roundLength(0.25 * (canvas.width() - 2 * kPictureBorder) * pixel);
  const int bar = static_cast<int>(std::lround(length / pixel));
  std::ostringstream label;
  label << length << " m";
  const int width = bar + Canvas::textWidth(label.str(), kLetter) + 3 * kPad;
  const int height = Canvas::textHeight(kLetter) + 2 * kPad;
  const int left = kPictureBorder + kPad;
  const int top = canvas.height() - kPictureBorder - kPad - height;
  canvas.fillRectangle(left, top, width, height, kPaper);
  canvas.fillRectangle(left + kPad, top + height / 2 - 4, bar, 8, kInk);
  canvas.fillRectangle(left + kPad + bar / 2, top + height / 2 - 2, bar - bar / 2 - 2, 4, kPaper);
  canvas.drawText(label.str(), left + 2 * kPad + bar, top + kPad, kLetter, kInk);
}

}  // namespace

void writePicture(const std::string& path, const Grid& grid, const Fields& fields,
                  const std::vector<Outline>& outlines, const GrainCloud& grains) {
  if (fields.bed.size() != grid.cells() || fields.depth.size() != grid.cells()) {
    throw std::runtime_error(path + ": the fields do not hold one value for each cell");
  }
  const QuietGdal quiet;
  const Relief relief = makeRelief(grid, fields, path);
  const int width = relief.surface.width + 2 * kPictureBorder;
  const int height = relief.surface.height + 2 * kPictureBorder;
  Canvas canvas(width, height, kPaper);
  canvas.fillRectangle(kPictureBorder - 2, kPictureBorder - 2, relief.surface.width + 4,
                       relief.surface.height + 4, kInk);
  paintRelief(relief, tonesOf(grains, grid, relief), bareDepth(grid), canvas);
  for (const Outline& outline : outlines) {
    drawOutline(outline, grid, relief.pixel, canvas);
  }
  drawScaleBar(relief.pixel, canvas);
  canvas.writePng(path);
}

}  // namespace shallow_sand
