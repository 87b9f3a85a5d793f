#include "benchmark/table1_scenes.h"

#include <cmath>
#include <string>

namespace shallow_sand {
namespace {

constexpr double kDuration = 1.6;  // of all motions [s]
constexpr double kSurface = 15.0;  // of a bed of sand [cells]

double spacingOf(const Scene& scene) { return scene.parameters.grid.spacing; }

/// Fills the map: depth(i, j) and bed(i, j) in cells, of columns and rows.
template <class Depth, class Bed>
void fill(Scene& scene, const Depth& depth, const Bed& bed) {
  const Grid grid = scene.parameters.grid.grid();
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      scene.depth[grid.index(i, j)] = static_cast<float>(spacingOf(scene) * depth(i, j));
      scene.bed[grid.index(i, j)] = static_cast<float>(spacingOf(scene) * bed(i, j));
    }
  }
}

template <class Depth>
void fillOnLevelBed(Scene& scene, const Depth& depth) {
  fill(scene, depth, [](int, int) { return 0.0; });
}

void fillBed(Scene& scene) {
  fillOnLevelBed(scene, [](int, int) { return kSurface; });
}

/// A column of sand in the middle of the map. [cells]
void fillColumn(Scene& scene, double radius, double height) {
  const Grid grid = scene.parameters.grid.grid();
  fillOnLevelBed(scene, [&](int i, int j) {
    const double distance = std::hypot(i + 0.5 - 0.5 * grid.columns, j + 0.5 - 0.5 * grid.rows);
    return distance < radius ? height : 0.0;
  });
}

/// Adds a body whose middle goes along path(time [s]), in cells, and is turned about the upright axis.
template <class Path>
void addBody(Scene& scene, const std::string& name, const Shape& shape, const Path& path,
             double heading = 0.0) {
  constexpr int kKeys = 32;
  SceneBody body;
  body.name = name;
  body.shape = shape;
  for (int k = 0; k <= kKeys; ++k) {
    PoseKey key;
    key.time = kDuration * k / kKeys;
    key.pose = Eigen::Translation3d(spacingOf(scene) * path(key.time)) *
               Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ());
    body.motion.push_back(key);
  }
  scene.bodies.push_back(body);
}

/// An upright cylinder whose tip is `depth` under the surface. [cells]
template <class Path>
void addStick(Scene& scene, double radius, double depth, const Path& path) {
  constexpr double kLength = 30.0;
  const double cell = spacingOf(scene);
  addBody(scene, "stick", Cylinder{radius * cell, kLength * cell}, [&](double time) {
    const Eigen::Vector2d place = path(time);
    return Eigen::Vector3d(place.x(), place.y(), kSurface - depth + 0.5 * kLength);
  });
}

/// A car on four wheels; its origin is between their lowest points.
TriangleMesh carOf(double cell) {
  constexpr double kRadius = 4.0;  // of a wheel [cells]
  constexpr double kWidth = 3.0;
  TriangleMesh car;
  const auto put = [&](const Shape& shape, double x, double y, double z, double roll) {
    car.append(triangulate(shape), Eigen::Translation3d(cell * Eigen::Vector3d(x, y, z)) *
                                       Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()));
  };
  put(Box{cell * Eigen::Vector3d(28.0, 12.0, 6.0)}, 0.0, 0.0, kRadius + 4.0, 0.0);
  for (const double x : {-9.0, 9.0}) {
    for (const double y : {-8.0, 8.0})
      put(Cylinder{kRadius * cell, kWidth * cell}, x, y, kRadius, 0.5 * M_PI);
  }
  return car;
}

/// Sand and bodies of a scene file of this package that has the same grid.
void fillFrom(Scene& scene, const std::string& name) {
  Scene file = loadScene(std::string(SHALLOW_SAND_SOURCE_DIR) + "/config/scenes/" + name);
  scene.bed = std::move(file.bed);
  scene.depth = std::move(file.depth);
  scene.bodies = std::move(file.bodies);
}

}  // namespace

void fillAvalanche(Scene& scene) {
  constexpr double kSlope = 0.7;  // 35 degrees
  const Grid grid = scene.parameters.grid.grid();
  const double foot = 0.7 * grid.columns;
  const auto snow = [&](int i, int j) {
    return i < 0.4 * grid.columns ? 15.0 + 3.0 * std::sin(0.05 * i) * std::sin(0.07 * j) : 2.0;
  };
  fill(scene, snow, [&](int i, int) { return i < foot ? kSlope * (foot - i) : 0.0; });
}

void fillButterfly(Scene& scene) {
  fillBed(scene);
  addStick(scene, 1.5, 5.0, [](double time) {
    const double angle = 1.0 * time;
    return Eigen::Vector2d(128.0 + 30.0 * std::sin(angle), 128.0 + 20.0 * std::sin(2.0 * angle));
  });
}

void fillFlattening(Scene& scene) {
  constexpr double kHeight = 20.0;
  constexpr double kSpeed = 25.0;  // [cells/s]
  fillBed(scene);
  const Box block{spacingOf(scene) * Eigen::Vector3d(6.0, 128.0, kHeight)};
  addBody(scene, "block", block, [&](double time) {
    return Eigen::Vector3d(100.0 + kSpeed * time, 128.0, kSurface - 2.0 + 0.5 * kHeight);
  });
}

void fillPile(Scene& scene) { fillColumn(scene, 12.0, 12.0); }

void fillDamBreak(Scene& scene) {
  const int middle = scene.parameters.grid.grid().columns / 2;
  fillOnLevelBed(scene, [&](int i, int) { return i < middle ? 60.0 : 0.0; });
}

void fillThreeShapes(Scene& scene) { fillFrom(scene, "three_shapes.yaml"); }

void fillCars(Scene& scene) {
  constexpr double kSpeed = 25.0;  // [cells/s]
  constexpr double kSunken = 2.0;  // into the sand [cells]
  fillBed(scene);
  const TriangleMesh car = carOf(spacingOf(scene));
  addBody(scene, "one", car,
          [](double time) { return Eigen::Vector3d(150.0 + kSpeed * time, 80.0, kSurface - kSunken); });
  addBody(
      scene, "other", car,
      [](double time) { return Eigen::Vector3d(350.0 - kSpeed * time, 170.0, kSurface - kSunken); }, M_PI);
}

void fillWriting(Scene& scene) {
  fillBed(scene);
  addStick(scene, 2.5, 5.0, [](double time) {
    return Eigen::Vector2d(200.0 + 20.0 * time, 128.0 + 10.0 * std::sin(4.0 * time));
  });
}

void fillTallColumn(Scene& scene) { fillColumn(scene, 10.0, 40.0); }

void fillFan(Scene& scene) { fillFrom(scene, "fan.yaml"); }

}  // namespace shallow_sand
