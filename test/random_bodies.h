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

/// The cell in which `place` lies, or the nearest one.
inline std::size_t cellNear(const Grid& grid, const Eigen::Vector2d& place) {
  const auto cell = [&](double position, double origin, int count) {
    return std::clamp(static_cast<int>((position - origin) / grid.spacing), 0, count - 1);
  };
  return grid.index(cell(place.x(), grid.origin_x, grid.columns), cell(place.y(), grid.origin_y, grid.rows));
}

inline double bedNear(const RandomSand& sand, const Eigen::Vector2d& place) {
  return static_cast<double>(sand.bed[cellNear(sand.parameters.grid.grid(), place)]);
}

/// Surface of the sand where `place` is. [m]
inline double surfaceNear(const RandomSand& sand, const Eigen::Vector2d& place) {
  return bedNear(sand, place) + static_cast<double>(sand.depth[cellNear(sand.parameters.grid.grid(), place)]);
}

/// A height for a body: at the surface, under it, or anywhere down to the bed. [m]
inline double randomHeight(std::mt19937& random, const RandomSand& sand, const Eigen::Vector2d& place,
                           double radius) {
  const double surface = surfaceNear(sand, place);
  switch (random() % 3) {
    case 0:
      return surface + uniform(random, -1.0, 1.0) * radius;
    case 1:
      return surface - uniform(random, 1.0, 2.0) * radius;
    default:
      return surface - uniform(random, 0.0, 1.0) * std::max(surface - bedNear(sand, place), 0.0);
  }
}

/// Moves the body and turns it, in the sand or near it, from 0 to `stop` [s]; one body in three spins on the
/// spot.
inline void moveThroughSand(std::mt19937& random, const RandomSand& sand, double stop, RandomBody& body) {
  const Grid grid = sand.parameters.grid.grid();
  constexpr int kKeys = 4;
  const bool spins = random() % 3 == 0;
  Eigen::Vector2d place = randomPlace(random, grid, 0.0);
  double height = randomHeight(random, sand, place, body.radius);
  for (int key = 0; key < kKeys; ++key) {
    body.motion.push_back({stop * key / (kKeys - 1), poseOf(place, height, randomRotation(random))});
    if (spins) continue;
    place = randomPlace(random, grid, 0.0);
    height = randomHeight(random, sand, place, body.radius);
  }
}

inline void addTo(Simulator& simulator, const RandomBody& body) {
  const std::size_t number = simulator.addBody("body", body.field);
  for (const PoseKey& key : body.motion) simulator.appendPose(number, key.time, key.pose);
}

}  // namespace shallow_sand
