#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "shallow_sand/scene/simulation.h"
#include "surface_profile.h"

namespace shallow_sand {

constexpr double kDegree = M_PI / 180.0;

/// Sand without slope on a level bed at z = 0, between walls; 32° unless changed.
inline Scene levelSand(const Eigen::Vector2d& size, double spacing, double depth) {
  Scene scene;
  scene.source = "test";
  scene.parameters.grid.size = size;
  scene.parameters.grid.spacing = spacing;
  scene.parameters.backend = Backend::cpu;
  scene.parameters.threads = 1;
  const std::size_t cells = scene.parameters.grid.grid().cells();
  scene.bed.assign(cells, 0.0f);
  scene.depth.assign(cells, static_cast<float>(depth));
  return scene;
}

inline Eigen::Quaterniond turned(double angle, const Eigen::Vector3d& axis) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis));
}

inline PoseKey poseKey(double time, const Eigen::Vector3d& position,
                       const Eigen::Quaterniond& rotation = Eigen::Quaterniond::Identity()) {
  PoseKey key;
  key.time = time;
  key.pose = Eigen::Translation3d(position) * rotation;
  return key;
}

/// From `from` to `to` at a steady speed [m/s], from time `start` [s] on.
inline std::vector<PoseKey> straightMotion(
    const Eigen::Vector3d& from, const Eigen::Vector3d& to, double speed, double start = 0.0,
    const Eigen::Quaterniond& rotation = Eigen::Quaterniond::Identity()) {
  return {poseKey(start, from, rotation), poseKey(start + (to - from).norm() / speed, to, rotation)};
}

/// Straight, and turned about a fixed axis by `rate` [rad/s]; a key every eighth of a turn at the latest, for
/// between two keys a body turns the shorter way.
inline std::vector<PoseKey> spinningMotion(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                                           double duration, const Eigen::Vector3d& axis, double rate) {
  const int parts = 1 + static_cast<int>(std::abs(rate) * duration / (0.25 * M_PI));
  std::vector<PoseKey> motion;
  for (int part = 0; part <= parts; ++part) {
    const double share = static_cast<double>(part) / parts;
    motion.push_back(
        poseKey(share * duration, from + share * (to - from), turned(rate * share * duration, axis)));
  }
  return motion;
}

/// Takes the sand away that lies within a body's first place or above it: as if sand had been put around it.
inline void carve(Scene& scene, const SceneBody& body, double bottom, const Eigen::Vector2d& size) {
  const Grid grid = scene.parameters.grid.grid();
  const Eigen::Isometry3d to_body = body.motion.front().pose.inverse();
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      const Eigen::Vector3d place = to_body * Eigen::Vector3d(grid.x(i), grid.y(j), 0.0);
      if (std::abs(place.x()) > 0.5 * size.x() || std::abs(place.y()) > 0.5 * size.y()) continue;
      float& depth = scene.depth[grid.index(i, j)];
      depth = std::min(depth, static_cast<float>(bottom));
    }
  }
}

/// Runs on until `until` [s]; returns the most sand that was found inside bodies on the way. [m³]
inline double runWatchingOverlap(Simulator& simulator, double until, int looks = 20) {
  const double begin = simulator.time();
  double most = 0.0;
  for (int look = 1; look <= looks; ++look) {
    simulator.advanceTo(begin + (until - begin) * look / looks);
    most = std::max(most, simulator.bodyOverlap());
  }
  return most;
}

/// Speed under which sand counts as settled [m/s]: a millimetre in a quarter of an hour.
constexpr double kCrawl = 1e-6;

/// Runs on, at least a fifth of a second, until the sand has settled or `longest` [s] have passed. Returns
/// whether it has.
inline bool settle(Simulator& simulator, double longest) {
  const double latest = simulator.time() + longest;
  do {
    simulator.advance(0.2);
  } while (simulator.maxSpeed() >= kCrawl && simulator.time() < latest);
  return simulator.maxSpeed() < kCrawl;
}

/// Fills the sand up, or cuts it, to a level surface: on bodies and beside them.
inline void makeLevel(Simulator& simulator, double surface) {
  const Grid& grid = simulator.grid();
  Edit edit;
  edit.region.shape = Region::Shape::rectangle;
  edit.region.size = static_cast<double>(grid.spacing) * Eigen::Vector2d(grid.columns, grid.rows);
  edit.region.center = Eigen::Vector2d(grid.origin_x, grid.origin_y) + 0.5 * edit.region.size;
  edit.operation = EditOperation::level;
  edit.value = surface;
  simulator.edit(edit);
}

/// All sand of the columns that `chosen` (x, y) picks. [m³]
template <class Chosen>
double volumeWhere(const Grid& grid, const Fields& fields, Chosen&& chosen) {
  double depth = 0.0;
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      if (chosen(grid.x(i), grid.y(j))) depth += fields.allDepth(grid.index(i, j));
    }
  }
  return depth * grid.cellArea();
}

/// Where the surface is highest on a line from `from` on, `length` [m] long.
inline Eigen::Vector2d highestOnLine(const Grid& grid, const Fields& fields, const Eigen::Vector2d& from,
                                     const Eigen::Vector2d& heading, double length) {
  const double stride = 0.25 * static_cast<double>(grid.spacing);
  Eigen::Vector2d top = from;
  for (double r = 0.0; r < length; r += stride) {
    const Eigen::Vector2d here = from + r * heading;
    if (surfaceAt(grid, fields, here) > surfaceAt(grid, fields, top)) top = here;
  }
  return top;
}

/// Friction holds no steeper slope; an avalanche keeps moving while the slope is already a little flatter
/// than the one at which it began. [degrees]
inline void expectSlopeAtRest(double slope, double friction_angle) {
  EXPECT_LT(slope, friction_angle + 0.5);
  EXPECT_GT(slope, friction_angle - 6.0);
}

inline void expectSoundSand(const Fields& fields) {
  for (std::size_t k = 0; k < fields.depth.size(); ++k) {
    ASSERT_TRUE(std::isfinite(fields.allDepth(k)) && fields.allDepth(k) >= 0.0 && fields.depth[k] >= 0.0f)
        << "depth " << fields.allDepth(k) << " in cell " << k;
    ASSERT_TRUE(std::isfinite(fields.momentum_x[k]) && std::isfinite(fields.momentum_y[k])) << "cell " << k;
  }
}

}  // namespace shallow_sand
