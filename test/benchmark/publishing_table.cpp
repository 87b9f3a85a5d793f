// Prints how long the sand's thread is held up for one publication of a map of 1024 x 1024 cells: as long as
// it did all by itself, and now that it only hands over what has changed.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "shallow_sand/device/tile_set.h"
#include "shallow_sand/ros/conversions.h"
#include "shallow_sand/ros/fields_change.h"
#include "shallow_sand/scene/simulation.h"

namespace shallow_sand {
namespace {

constexpr int kSide = 1024;
constexpr double kSpacing = 0.02;  // [m]

double milliseconds(const std::function<void()>& function) {
  const auto begin = std::chrono::steady_clock::now();
  function();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

Scene level() {
  Scene scene;
  scene.parameters.grid.size = Eigen::Vector2d::Constant(kSide * kSpacing);
  scene.parameters.grid.spacing = kSpacing;
  scene.parameters.backend = Backend::cpu;
  scene.bed.assign(static_cast<std::size_t>(kSide) * kSide, 0.0f);
  scene.depth.assign(scene.bed.size(), 0.3f);
  return scene;
}

/// As wide as an excavator's bucket, and as fast.
Scene withBlade() {
  Scene scene = level();
  SceneBody blade;
  blade.name = "blade";
  blade.shape = Box{{0.1, 1.0, 0.5}};
  PoseKey from;
  from.pose = Eigen::Translation3d(5.0, 5.0, 0.45);
  PoseKey to;
  to.time = 20.0;
  to.pose = Eigen::Translation3d(10.0, 5.0, 0.45);
  blade.motion = {from, to};
  scene.bodies = {blade};
  return scene;
}

/// All cells move.
Scene sloshing() {
  Scene scene = level();
  scene.parameters.material.friction_angle = 0.0;
  for (std::size_t k = 0; k < scene.depth.size(); ++k) {
    const double along = static_cast<double>(k % kSide) / kSide;
    const double across = static_cast<double>(k / kSide) / kSide;
    scene.depth[k] += static_cast<float>(0.1 * std::sin(40.0 * along) * std::sin(30.0 * across));
  }
  return scene;
}

void printRow(const std::string& name, const Scene& scene) {
  Simulator simulator = buildSimulator(scene);
  const Grid grid = simulator.grid();
  std::vector<double> alone, given, asked;
  FieldsChange parcels[2];
  for (int publication = 0; publication <= 20; ++publication) {
    simulator.advanceTo(0.1 * (publication + 1));
    const double whole =
        milliseconds([&] { toPointCloud(grid, simulator.fields(), "sand", ros::Time(1.0)); });
    std::vector<Window> changes;
    const double request = milliseconds([&] {
      simulator.requestFields();
      changes = simulator.takeChanges();
    });
    // To two threads.
    const double handed = milliseconds([&] {
      for (FieldsChange& parcel : parcels)
        parcel = changeOf(simulator.collectFields(), changes, grid, std::move(parcel));
    });
    // The first one is of the whole map.
    if (publication == 0) continue;
    alone.push_back(whole);
    asked.push_back(request);
    given.push_back(handed);
  }
  std::printf("| %s | %.2f | %.3f | %.3f |\n", name.c_str(), median(alone), median(asked), median(given));
}

}  // namespace
}  // namespace shallow_sand

int main() {
  std::printf("| ms | fields and ~points by itself | fields that have changed | handed to two threads |\n");
  std::printf("|---|---|---|---|\n");
  shallow_sand::printRow("at rest", shallow_sand::level());
  shallow_sand::printRow("a blade 1 m wide, 0.25 m/s", shallow_sand::withBlade());
  shallow_sand::printRow("all cells move", shallow_sand::sloshing());
  return 0;
}
