#include "sand_layer.h"

#include <algorithm>

namespace shallow_sand {

SandLayer evenLayer(double added) {
  return [=](const Eigen::Vector2d&, double, double depth) { return depth + added; };
}

SandLayer fillToSurface(double elevation) {
  return [=](const Eigen::Vector2d&, double bed, double depth) { return std::max(depth, elevation - bed); };
}

SandLayer boxLayer(const Eigen::Vector2d& minimum, const Eigen::Vector2d& maximum, double added) {
  return [=](const Eigen::Vector2d& centre, double, double depth) {
    const bool inside = (centre.array() >= minimum.array()).all() && (centre.array() < maximum.array()).all();
    return inside ? depth + added : depth;
  };
}

SandLayer cylinderLayer(const Eigen::Vector2d& middle, double radius, double added) {
  return [=](const Eigen::Vector2d& centre, double, double depth) {
    return (centre - middle).norm() <= radius ? depth + added : depth;
  };
}

SandLayer coneLayer(const Eigen::Vector2d& middle, double height, double slope) {
  return [=](const Eigen::Vector2d& centre, double, double depth) {
    return depth + std::max(0.0, height - slope * (centre - middle).norm());
  };
}

}  // namespace shallow_sand
