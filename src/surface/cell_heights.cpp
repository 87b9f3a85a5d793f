#include "shallow_sand/surface/cell_heights.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>
#include <utility>

#include "shallow_sand/core/parameters.h"
#include "shallow_sand/device/window.h"

namespace shallow_sand {
namespace {

using Corners = std::array<Eigen::Vector3d, 3>;

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Places along a line: none, if they end before they begin.
struct Interval {
  double begin;
  double end;
};

/// A triangle seen from above, in cells along x and y, and in metres along z.
class FlatTriangle {
 public:
  /// Beside a side, still counted as within. [cells]
  static constexpr double kTolerance = 1e-6;

  explicit FlatTriangle(const Corners& corners) : corners_(corners) {
    twice_area_ = cross(side(0), -side(2));
    if (twice_area_ < 0.0) std::swap(corners_[1], corners_[2]);
    twice_area_ = std::abs(twice_area_);
    const auto heights = std::minmax({corners[0].z(), corners[1].z(), corners[2].z()});
    lowest_ = heights.first;
    highest_ = heights.second;
    const double rise_1 = corners_[1].z() - corners_[0].z();
    const double rise_2 = corners_[2].z() - corners_[0].z();
    slope_ = Eigen::Vector2d(cross({rise_1, side(0).y()}, {rise_2, -side(2).y()}),
                             cross({side(0).x(), rise_1}, {-side(2).x(), rise_2})) /
             twice_area_;
  }

  /// It has no area that would tell a height.
  bool isUpright() const {
    const double longest = std::max({side(0).norm(), side(1).norm(), side(2).norm()});
    return !(twice_area_ > 1e-9 * longest * longest);
  }

  /// Where along x it is at this y: to the left of all its sides, which go round counter-clockwise.
  Interval at(double y) const {
    Interval x{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector2d along = side(k);
      // Twice the area that a place at x = 0 of the side's begin spans with the side, and the tolerance.
      const double area = along.x() * (y - corners_[k].y()) + kTolerance * along.norm();
      if (along.y() > 0.0) x.end = std::min(x.end, corners_[k].x() + area / along.y());
      if (along.y() < 0.0) x.begin = std::max(x.begin, corners_[k].x() + area / along.y());
      if (along.y() == 0.0 && area < 0.0) return {1.0, 0.0};
    }
    return x;
  }

  /// Only for triangles that are not upright.
  double height(const Eigen::Vector2d& place) const {
    return std::clamp(corners_[0].z() + slope_.dot(place - corners_[0].head<2>()), lowest_, highest_);
  }

 private:
  Eigen::Vector2d side(std::size_t k) const { return (corners_[(k + 1) % 3] - corners_[k]).head<2>(); }

  Corners corners_;
  double twice_area_;
  Eigen::Vector2d slope_;  // of height [m] by cells
  double lowest_;
  double highest_;
};

/// Cells whose middles lie in an interval, of those from `begin` to `end`.
std::pair<int, int> cellsIn(const Interval& x, int begin, int end) {
  const auto first =
      std::clamp(std::ceil(x.begin - 0.5), static_cast<double>(begin), static_cast<double>(end));
  const auto last = std::clamp(std::floor(x.end + 0.5), static_cast<double>(begin), static_cast<double>(end));
  return {static_cast<int>(first), static_cast<int>(last)};
}

}  // namespace

void MeanHeights::add(const Eigen::Vector3d& point) {
  const double spacing = static_cast<double>(grid_.spacing);
  const double column = std::floor((point.x() - grid_.origin_x) / spacing);
  const double row = std::floor((point.y() - grid_.origin_y) / spacing);
  if (!(column >= 0.0 && column < grid_.columns && row >= 0.0 && row < grid_.rows)) return;
  const std::size_t cell = grid_.index(static_cast<int>(column), static_cast<int>(row));
  sums_[cell] += point.z();
  ++counts_[cell];
}

CellValues MeanHeights::values() const {
  CellValues result{std::vector<float>(grid_.cells()), std::vector<std::uint8_t>(grid_.cells())};
  for (std::size_t k = 0; k < counts_.size(); ++k) {
    if (counts_[k] == 0) continue;
    result.values[k] = static_cast<float>(sums_[k] / counts_[k]);
    result.given[k] = 1;
  }
  return result;
}

void requireBounded(const CellValues& heights, const Grid& grid) {
  constexpr double kHighest = 1e6;
  for (std::size_t k = 0; k < heights.values.size(); ++k) {
    if (heights.given[k] == 0 || std::abs(static_cast<double>(heights.values[k])) <= kHighest) continue;
    const auto columns = static_cast<std::size_t>(grid.columns);
    std::ostringstream found;
    found << heights.values[k] << " in cell (" << k % columns << ", " << k / columns << ")";
    throw InvalidParameter("height", found.str(), "metres, at most a million");
  }
}

HighestTriangles::HighestTriangles(const Grid& grid)
    : grid_(grid), values_{std::vector<float>(grid.cells()), std::vector<std::uint8_t>(grid.cells())} {}

void HighestTriangles::add(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const double spacing = static_cast<double>(grid_.spacing);
  const auto inCells = [&](const Eigen::Vector3d& p) {
    return Eigen::Vector3d((p.x() - grid_.origin_x) / spacing, (p.y() - grid_.origin_y) / spacing, p.z());
  };
  const Corners corners{inCells(a), inCells(b), inCells(c)};
  const FlatTriangle triangle(corners);
  if (triangle.isUpright()) return;
  const Eigen::Vector3d low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]);
  const Eigen::Vector3d high = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
  const double margin = 2.0 * FlatTriangle::kTolerance * spacing;
  const Window window = Window::around(spacing * low.x() - margin, spacing * low.y() - margin,
                                       spacing * high.x() + margin, spacing * high.y() + margin, grid_);
  if (window.empty()) return;
  for (int j = window.row_begin; j < window.row_end; ++j) {
    const auto [begin, end] = cellsIn(triangle.at(j + 0.5), window.column_begin, window.column_end);
    for (int i = begin; i < end; ++i) raise(grid_.index(i, j), triangle.height({i + 0.5, j + 0.5}));
    covered_ += 1 + static_cast<std::uint64_t>(std::max(end - begin, 0));
  }
  requireFewLayers();
}

void HighestTriangles::raise(std::size_t cell, double height) {
  const float value = static_cast<float>(height);
  if (values_.given[cell] == 0 || value > values_.values[cell]) values_.values[cell] = value;
  values_.given[cell] = 1;
}

void HighestTriangles::requireFewLayers() const {
  constexpr std::uint64_t kLayers = 16;
  constexpr std::uint64_t kOfSmallMaps = 1u << 24;
  if (covered_ <= kLayers * grid_.cells() + kOfSmallMaps) return;
  throw InvalidParameter("triangles", std::to_string(covered_) + " cells under all of them",
                         "those of a surface, which lie beside each other");
}

}  // namespace shallow_sand
