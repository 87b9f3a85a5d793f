#include "shallow_sand/surface/surface_query.h"

#include <algorithm>
#include <cmath>

namespace shallow_sand {
namespace {

/// Two cells along an axis, and how far a place is from the middle of the first to that of the second. At the
/// edge of the map that is less than 0 or more than 1.
struct Between {
  int first;
  int second;  ///< the same one, where there is but one
  double share;
};

Between between(double cells_from_edge, int count) {
  const double from_middle = cells_from_edge - 0.5;
  const int first = std::clamp(static_cast<int>(std::floor(from_middle)), 0, std::max(count - 2, 0));
  return {first, std::min(first + 1, count - 1), from_middle - first};
}

/// A field by its values in four cells.
struct Patch {
  double south_west;
  double south_east;
  double north_west;
  double north_east;

  double at(double x, double y) const {
    const double south = south_west + x * (south_east - south_west);
    const double north = north_west + x * (north_east - north_west);
    return south + y * (north - south);
  }
  /// By the way to the next cell.
  double slopeX(double y) const {
    return (south_east - south_west) + y * ((north_east - north_west) - (south_east - south_west));
  }
  double slopeY(double x) const {
    return (north_west - south_west) + x * ((north_east - south_east) - (north_west - south_west));
  }
};

}  // namespace

std::optional<SurfacePoint> surfaceAt(const Grid& grid, const Fields& fields, const Eigen::Vector2d& place) {
  const double spacing = static_cast<double>(grid.spacing);
  const double x = (place.x() - grid.origin_x) / spacing;
  const double y = (place.y() - grid.origin_y) / spacing;
  if (!(x >= 0.0 && x <= grid.columns && y >= 0.0 && y <= grid.rows)) return std::nullopt;
  const Between column = between(x, grid.columns);
  const Between row = between(y, grid.rows);
  const auto patchOf = [&](const auto& value) {
    return Patch{value(grid.index(column.first, row.first)), value(grid.index(column.second, row.first)),
                 value(grid.index(column.first, row.second)), value(grid.index(column.second, row.second))};
  };
  const Patch surface = patchOf([&](std::size_t k) { return static_cast<double>(fields.surface(k)); });
  const Patch depth = patchOf([&](std::size_t k) { return static_cast<double>(fields.allDepth(k)); });
  const Eigen::Vector3d normal(-surface.slopeX(row.share) / spacing, -surface.slopeY(column.share) / spacing,
                               1.0);
  return SurfacePoint{surface.at(column.share, row.share), std::max(0.0, depth.at(column.share, row.share)),
                      normal.normalized()};
}

}  // namespace shallow_sand
