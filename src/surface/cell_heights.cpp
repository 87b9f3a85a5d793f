#include "shallow_sand/surface/cell_heights.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "shallow_sand/core/parameters.h"
#include "shallow_sand/device/window.h"

namespace shallow_sand {
namespace {

using Corners = std::array<Eigen::Vector3d, 3>;

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

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
  }

  /// It has no area that would tell a height.
  bool isUpright() const {
    const double longest = std::max({side(0).norm(), side(1).norm(), side(2).norm()});
    return !(twice_area_ > 1e-9 * longest * longest);
  }

  /// Whether a place is over it. @param height there
  bool holds(const Eigen::Vector2d& place, double& height) const {
    double sum = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector2d along = side(k);
      const double weight = cross(along, place - corners_[k].head<2>());
      if (weight < -kTolerance * along.norm()) return false;
      sum += weight * corners_[(k + 2) % 3].z();  // of the corner across
    }
    height = std::clamp(sum / twice_area_, lowest_, highest_);
    return true;
  }

 private:
  Eigen::Vector2d side(std::size_t k) const { return (corners_[(k + 1) % 3] - corners_[k]).head<2>(); }

  Corners corners_;
  double twice_area_;
  double lowest_;
  double highest_;
};

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
  constexpr std::uint64_t kMostLookedAt = 1u << 30;
  looked_at_ += window.cells();
  if (looked_at_ > kMostLookedAt) {
    throw InvalidParameter("triangles", "more than 2^30 cells under all of them together",
                           "triangles of a surface, which lie beside each other");
  }
  for (int j = window.row_begin; j < window.row_end; ++j) {
    for (int i = window.column_begin; i < window.column_end; ++i) {
      double height = 0.0;
      if (!triangle.holds({i + 0.5, j + 0.5}, height)) continue;
      const std::size_t cell = grid_.index(i, j);
      const float value = static_cast<float>(height);
      if (values_.given[cell] == 0 || value > values_.values[cell]) values_.values[cell] = value;
      values_.given[cell] = 1;
    }
  }
}

}  // namespace shallow_sand
