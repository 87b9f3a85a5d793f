#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "shallow_sand/surface/blocks.h"
#include "shallow_sand/surface/surface_colour.h"

namespace shallow_sand {

inline Eigen::Vector3f normalOf(const Eigen::Vector2d& gradient) {
  const Eigen::Vector2f slope = gradient.cast<float>();
  return Eigen::Vector3f(-slope.x(), -slope.y(), 1.0f).normalized();
}

/// Elevations, materials and slopes at the middles of a lattice's cells.
class Relief {
 public:
  /// Refers to all that it is given. @param bare_depth sand thinner than this is bare bed [m]
  Relief(const Lattice& lattice, const Fields& fields, float bare_depth)
      : lattice_(lattice), fields_(fields), bare_depth_(bare_depth) {}

  const Lattice& lattice() const { return lattice_; }
  double bareDepth() const { return static_cast<double>(bare_depth_); }
  double bed(std::size_t cell) const { return static_cast<double>(fields_.bed[cell]); }
  double depth(std::size_t cell) const { return static_cast<double>(fields_.depth[cell]); }
  /// s = h + b, also below what lies on bodies. [m]
  double ground(std::size_t cell) const { return bed(cell) + depth(cell); }
  /// What one sees from above. [m]
  double visible(std::size_t cell) const { return static_cast<double>(fields_.surface(cell)); }
  bool hasLoads() const { return !fields_.load.empty(); }
  bool hasLoad(std::size_t cell) const { return fields_.hasLoad(cell); }
  bool isSand(std::size_t cell) const { return !(fields_.depth[cell] < bare_depth_); }
  SurfaceMaterial material(std::size_t cell) const {
    return isSand(cell) ? SurfaceMaterial::sand : SurfaceMaterial::bed;
  }

  /// Gradients of the bed, also under sand; of the ground's sand, where there is some; and of what one sees.
  Eigen::Vector2d bedGradient(std::size_t i, std::size_t j) const {
    const auto elevation = [this](std::size_t cell) { return bed(cell); };
    return gradient(i, j, elevation, everywhere).first;
  }
  /// From sand alone, one-sided at a shore; where it has no sand beside it, sand lies along the bed.
  Eigen::Vector2d sandGradient(std::size_t i, std::size_t j) const {
    const auto elevation = [this](std::size_t cell) { return ground(cell); };
    auto [slope, known] = gradient(i, j, elevation, [this](std::size_t cell) { return isSand(cell); });
    if (known[0] && known[1]) return slope;
    const Eigen::Vector2d along_bed = bedGradient(i, j);
    for (const int axis : {0, 1}) {
      if (!known[axis]) slope[axis] = along_bed[axis];
    }
    return slope;
  }
  Eigen::Vector2d visibleGradient(std::size_t i, std::size_t j) const {
    const auto elevation = [this](std::size_t cell) { return visible(cell); };
    const double own = visible(lattice_.index(i, j));
    return gradient(i, j, elevation, [this, own](std::size_t cell) { return !isStep(own, visible(cell)); })
        .first;
  }
  bool isStep(double low, double high) const {
    return std::abs(high - low) > static_cast<double>(kSteepest) * lattice_.width.front();
  }
  /// Of the ground's sand or its bare bed, whichever there is.
  Eigen::Vector3f groundNormal(std::size_t i, std::size_t j) const {
    return normalOf(isSand(lattice_.index(i, j)) ? sandGradient(i, j) : bedGradient(i, j));
  }

 private:
  static bool everywhere(std::size_t) { return true; }

  /// The slope along one axis at number `at` of `places`: between both neighbours, or from one to the cell
  /// itself where the other does not count; none if neither does.
  template <class Elevation, class Counts>
  static std::optional<double> slope(const std::vector<double>& places, std::size_t at, std::size_t cell,
                                     std::size_t stride, const Elevation& elevation, const Counts& counts) {
    const std::size_t before = at > 0 && counts(cell - stride) ? 1 : 0;
    const std::size_t after = at + 1 < places.size() && counts(cell + stride) ? 1 : 0;
    if (before + after == 0) return std::nullopt;
    return (elevation(cell + after * stride) - elevation(cell - before * stride)) /
           (places[at + after] - places[at - before]);
  }

  /// The gradient, 0 along axes on which it is not known; and on which it is.
  template <class Elevation, class Counts>
  std::pair<Eigen::Vector2d, std::array<bool, 2>> gradient(std::size_t i, std::size_t j,
                                                           const Elevation& elevation,
                                                           const Counts& counts) const {
    const std::size_t cell = lattice_.index(i, j);
    const std::optional<double> x = slope(lattice_.x, i, cell, 1, elevation, counts);
    const std::optional<double> y = slope(lattice_.y, j, cell, lattice_.columns(), elevation, counts);
    return {{x.value_or(0.0), y.value_or(0.0)}, {x.has_value(), y.has_value()}};
  }

  const Lattice& lattice_;
  const Fields& fields_;
  float bare_depth_;
};

}  // namespace shallow_sand
