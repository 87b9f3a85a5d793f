#pragma once

#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "random_fields.h"
#include "shallow_sand/bodies/body_geometry.h"
#include "shallow_sand/scene/simulation.h"

namespace shallow_sand {

/// A body and where it is at which times.
struct RandomBody {
  Shape shape;
  double radius;  ///< no part of it is farther from its origin [m]
  std::shared_ptr<const DistanceField> field;
  std::vector<PoseKey> motion;
};

/// A box, a cylinder or a sphere, from two to nine cells large; it has no pose yet.
inline RandomBody randomBody(std::mt19937& random, double spacing) {
  const auto length = [&] { return uniform(random, 2.0, 9.0) * spacing; };
  RandomBody body;
  switch (random() % 3) {
    case 0:
      body.shape = Box{{length(), length(), length()}};
      break;
    case 1:
      body.shape = Cylinder{0.5 * length(), length()};
      break;
    default:
      body.shape = Sphere{0.5 * length()};
  }
  const TriangleMesh mesh = triangulate(body.shape);
  body.radius = 0.0;
  for (const Eigen::Vector3d& vertex : mesh.vertices) body.radius = std::max(body.radius, vertex.norm());
  body.field =
      std::make_shared<const DistanceField>(computeDistanceField(mesh, distanceSpacing(mesh, spacing)));
  return body;
}

inline Eigen::Quaterniond randomRotation(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random)).normalized();
}

/// A place over the sand; the edge of the grid is at least `margin` away where the grid is large enough. [m]
inline Eigen::Vector2d randomPlace(std::mt19937& random, const Grid& grid, double margin) {
  const auto along = [&](double origin, int count) {
    const double length = count * static_cast<double>(grid.spacing);
    const double inset = std::min(margin, 0.5 * length);
    return origin + uniform(random, inset, length - inset);
  };
  const double x = along(grid.origin_x, grid.columns);
  return {x, along(grid.origin_y, grid.rows)};
}

inline Eigen::Isometry3d poseOf(const Eigen::Vector2d& place, double height,
                                const Eigen::Quaterniond& rotation) {
  return Eigen::Translation3d(place.x(), place.y(), height) * rotation;
}

/// Surface of the sand where `place` is. [m]
inline double surfaceNear(const RandomSand& sand, const Eigen::Vector2d& place) {
  const Grid grid = sand.parameters.grid.grid();
  const auto cell = [&](double position, double origin, int count) {
    return std::clamp(static_cast<int>((position - origin) / grid.spacing), 0, count - 1);
  };
  const std::size_t k =
      grid.index(cell(place.x(), grid.origin_x, grid.columns), cell(place.y(), grid.origin_y, grid.rows));
  return static_cast<double>(sand.bed[k]) + static_cast<double>(sand.depth[k]);
}

/// Moves the body and turns it, through the sand's surface or near it, from 0 to `stop` [s].
inline void moveThroughSand(std::mt19937& random, const RandomSand& sand, double stop, RandomBody& body) {
  const Grid grid = sand.parameters.grid.grid();
  constexpr int kKeys = 4;
  for (int key = 0; key < kKeys; ++key) {
    const Eigen::Vector2d place = randomPlace(random, grid, 0.0);
    const double height = surfaceNear(sand, place) + uniform(random, -1.0, 1.0) * body.radius;
    body.motion.push_back({stop * key / (kKeys - 1), poseOf(place, height, randomRotation(random))});
  }
}

inline void addTo(Simulator& simulator, const RandomBody& body) {
  const std::size_t number = simulator.addBody("body", body.field);
  for (const PoseKey& key : body.motion) simulator.appendPose(number, key.time, key.pose);
}

}  // namespace shallow_sand
