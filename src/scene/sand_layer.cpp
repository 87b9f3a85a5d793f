#include "sand_layer.h"

#include <algorithm>
#include <utility>

namespace shallow_sand {

SandLayer evenLayer(double added) {
  return [=](const Column&, double depth) { return depth + added; };
}

SandLayer fillToSurface(double elevation) {
  return [=](const Column& column, double depth) { return std::max(depth, elevation - column.bed); };
}

SandLayer unevenLayer(std::vector<float> added) {
  return [added = std::move(added)](const Column& column, double depth) {
    return depth + static_cast<double>(added[column.cell]);
  };
}

SandLayer fillToSurfaces(std::vector<float> elevations) {
  return [elevations = std::move(elevations)](const Column& column, double depth) {
    return std::max(depth, static_cast<double>(elevations[column.cell]) - column.bed);
  };
}

SandLayer boxLayer(const Eigen::Vector2d& minimum, const Eigen::Vector2d& maximum, double added) {
  return [=](const Column& column, double depth) {
    const bool inside =
        (column.centre.array() >= minimum.array()).all() && (column.centre.array() < maximum.array()).all();
    return inside ? depth + added : depth;
  };
}

SandLayer cylinderLayer(const Eigen::Vector2d& middle, double radius, double added) {
  return [=](const Column& column, double depth) {
    return (column.centre - middle).norm() <= radius ? depth + added : depth;
  };
}

SandLayer coneLayer(const Eigen::Vector2d& middle, double height, double slope) {
  return [=](const Column& column, double depth) {
    return depth + std::max(0.0, height - slope * (column.centre - middle).norm());
  };
}

}  // namespace shallow_sand
