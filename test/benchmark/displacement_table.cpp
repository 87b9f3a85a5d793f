#include <cmath>
#include <cstdio>
#include <string>

#include "shallow_sand/scene/simulation.h"

/// Prints, as a table in Markdown, how much sand is inside a body as a share of what the body takes up below
/// the old surface: with Eq. 20-24 alone, and with displacement.
namespace shallow_sand {
namespace {

constexpr double kSurface = 0.3;
const Eigen::Vector3d kStart{0.6, 1.0, 0.0};

struct Case {
  std::string name;
  Eigen::Vector3d size;
  Eigen::Vector3d from;  ///< of the body's middle
  Eigen::Vector3d to;
  double speed;     ///< [m/s]
  double taken_up;  ///< at the end, below the old surface [m³]
};

Case bladeAt(double speed) {
  const Eigen::Vector3d size(0.1, 1.0, 0.5);
  const double cut = 0.1;
  const Eigen::Vector3d from = kStart + Eigen::Vector3d(0.0, 0.0, kSurface - cut + 0.5 * size.z());
  char name[64];
  std::snprintf(name, sizeof(name), "blade cutting %.1f m deep, %.2f m/s", cut, speed);
  return {name, size, from, from + Eigen::Vector3d(1.6, 0.0, 0.0), speed, size.x() * size.y() * cut};
}

Case blockAt(double speed) {
  const Eigen::Vector3d size(0.4, 0.4, 0.5);
  const double pressed = 0.14;
  const Eigen::Vector3d to(2.0, 1.0, kSurface - pressed + 0.5 * size.z());
  char name[64];
  std::snprintf(name, sizeof(name), "block pressed %.2f m deep, %.2f m/s", pressed, speed);
  return {name, size,  to + Eigen::Vector3d(0.0, 0.0, pressed + 0.02),
          to,   speed, size.x() * size.y() * pressed};
}

Scene sceneOf(const Case& about) {
  Scene scene;
  scene.source = about.name;
  scene.parameters.grid.size = {4.0, 2.0};
  scene.parameters.grid.spacing = 0.02;
  scene.parameters.backend = Backend::cpu;
  const std::size_t cells = scene.parameters.grid.grid().cells();
  scene.bed.assign(cells, 0.0f);
  scene.depth.assign(cells, static_cast<float>(kSurface));
  SceneBody body;
  body.name = "body";
  body.shape = Box{about.size};
  PoseKey first;
  first.pose = Eigen::Translation3d(about.from);
  PoseKey last;
  last.time = (about.to - about.from).norm() / about.speed;
  last.pose = Eigen::Translation3d(about.to);
  body.motion = {first, last};
  scene.bodies = {body};
  return scene;
}

/// Sand inside the body at the end of its way. [%]
double inside(const Case& about, bool displacement) {
  Scene scene = sceneOf(about);
  scene.parameters.coupling = displacement ? Coupling::displacement : Coupling::drag;
  const double ends = scene.bodies.front().motion.back().time;
  Simulator simulator = buildSimulator(scene);
  simulator.advanceTo(ends);
  return 100.0 * simulator.bodyOverlap() / about.taken_up;
}

void printTable() {
  std::printf("| sand inside the body / volume it takes up | Eq. 20-24 alone | with displacement |\n");
  std::printf("|---|---|---|\n");
  for (const Case& about : {bladeAt(0.05), bladeAt(0.5), blockAt(0.05), blockAt(0.5)}) {
    const double alone = inside(about, false);
    std::printf("| %s | %.1f %% | %.2f %% |\n", about.name.c_str(), alone, inside(about, true));
  }
}

}  // namespace
}  // namespace shallow_sand

int main() {
  shallow_sand::printTable();
  return 0;
}
