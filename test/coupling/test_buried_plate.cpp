#include <gtest/gtest.h>

#include "coupling/bodies_in_sand.h"
#include "random_fields.h"
#include "random_seed.h"

namespace shallow_sand {
namespace {

constexpr double kSpacing = 0.02;
constexpr double kSurface = 0.4;
constexpr double kBottom = 0.18;  ///< of the plate
const Eigen::Vector3d kPlate{0.4, 0.4, 0.04};

SceneBody plateOf(const Eigen::Vector3d& size, std::vector<PoseKey> motion) {
  SceneBody plate;
  plate.name = "plate";
  plate.shape = Box{size};
  plate.motion = std::move(motion);
  return plate;
}

/// Sand around and above bodies that sit a little in the sand below them. The scene's sand ends there.
Simulator buried(const Scene& scene, double surface) {
  Simulator simulator = buildSimulator(scene);
  simulator.advance(0.5);  // sand has gone out of the bodies' way
  makeLevel(simulator, surface);
  return simulator;
}

double largestStep(const Grid& grid, const Fields& fields, double surface) {
  double largest = 0.0;
  for (std::size_t k = 0; k < grid.cells(); ++k)
    largest = std::max(largest, std::abs(fields.surface(k) - surface));
  return largest;
}

TEST(BuriedPlate, MovesUnderTheSandWithABumpAboveAndNoTrenchBehind) {
  const double speed = 0.2;
  const double begins = 1.0;
  const Eigen::Vector3d from(0.6, 0.6, kBottom + 0.5 * kPlate.z());
  const Eigen::Vector3d to = from + Eigen::Vector3d(1.0, 0.0, 0.0);
  Scene scene = levelSand({2.2, 1.2}, kSpacing, kBottom + 0.001);
  scene.bodies = {plateOf(kPlate, straightMotion(from, to, speed, begins))};
  Simulator simulator = buried(scene, kSurface);
  simulator.advanceTo(begins);
  const Grid& grid = simulator.grid();
  const double volume = kPlate.prod();
  const double ends = begins + 1.0 / speed;
  const double most_inside = runWatchingOverlap(simulator, ends);

  const Fields pushed = simulator.fields();
  double bump = 0.0;
  double lowest = kSurface;
  for (double x = from.x(); x < to.x() + 0.5 * kPlate.x(); x += kSpacing) {
    const double surface = surfaceAt(grid, pushed, {x, 0.6});
    if (x > to.x() - 0.5 * kPlate.x()) bump = std::max(bump, surface - kSurface);
    // Where the plate began it leaves a hollow of its own volume.
    const double filled = from.x() + 0.5 * kPlate.x() + 2.0 * kPlate.z() / std::tan(32.0 * M_PI / 180.0);
    if (x > filled && x < to.x() - kPlate.x()) lowest = std::min(lowest, surface);
  }
  std::printf("bump %.4f m, behind %.4f m lower than before; sand inside at most %.2f %%\n", bump,
              kSurface - lowest, 100.0 * most_inside / volume);
  EXPECT_GT(bump, 0.001);
  EXPECT_LT(bump, kPlate.z() * 1.5);
  EXPECT_LT(kSurface - lowest, 0.005);
  EXPECT_LT(most_inside, 0.05 * volume);
  EXPECT_LT(simulator.ledger().error(), 1e-6);
}

/// A plate somewhere in the middle of the map, that lies a millimetre deep in the sand below it.
Scene restingPlate(std::mt19937& random) {
  const double bottom = uniform(random, 0.05, 0.25);
  const auto side = [&] { return uniform(random, 0.1, 0.5); };
  const Eigen::Vector3d size(side(), side(), uniform(random, 0.03, 0.1));
  const Eigen::Vector3d place(uniform(random, 0.4, 0.8), uniform(random, 0.4, 0.6), bottom + 0.5 * size.z());
  const double yaw = uniform(random, -M_PI, M_PI);
  Scene scene = levelSand({1.2, 1.0}, kSpacing, bottom + 0.001);
  scene.bodies = {plateOf(size, {poseKey(0.0, place, turned(yaw, Eigen::Vector3d::UnitZ()))})};
  return scene;
}

TEST(BuriedPlate, LevelSandAroundAndAboveRestsInEveryBit) {
  std::mt19937 random = seededGenerator();
  for (int number = 0; number < 8 && !HasFailure(); ++number) {
    SCOPED_TRACE(number);
    Simulator simulator = buried(restingPlate(random), kSurface);
    simulator.advance(0.01);
    const Fields filled = simulator.fields();
    EXPECT_LT(largestStep(simulator.grid(), filled, kSurface), 1e-6);
    EXPECT_EQ(simulator.activeCells(), 0u);
    simulator.advance(2.0);
    expectSameBits(simulator.fields(), filled);
    EXPECT_EQ(simulator.bodyOverlap(), 0.0);
  }
}

/// Sand that was there when the body was put in: it goes somewhere, then all of it rests.
TEST(BuriedPlate, SandSettlesAfterABodyWasPutInIt) {
  std::mt19937 random = seededGenerator();
  for (int number = 0; number < 4; ++number) {
    SCOPED_TRACE(number);
    const double side = uniform(random, 0.1, 0.4);
    const Eigen::Vector3d size(side, side, uniform(random, 0.03, 0.1));
    const Eigen::Vector3d place(uniform(random, 0.5, 0.7), uniform(random, 0.5, 0.7),
                                uniform(random, 0.1, 0.25));
    Scene scene = levelSand({1.2, 1.2}, kSpacing, kSurface);
    scene.bodies = {plateOf(size, {poseKey(0.0, place)})};
    Simulator simulator = buildSimulator(scene);
    const bool settles = settle(simulator, 20.0);
    const double off = largestStep(simulator.grid(), simulator.fields(), kSurface);
    std::printf("settled %d at %.1f s, surface up to %.4f m off its old level, %zu cells crawl\n", settles,
                simulator.time(), off, simulator.activeCells());
    EXPECT_TRUE(settles);
    // No more than what the body takes up had to go, and nothing may have slid off it.
    EXPECT_LT(off, size.z() * 1.5);
    EXPECT_LT(simulator.bodyOverlap(), 1e-3 * size.prod());
    EXPECT_LT(simulator.ledger().error(), 1e-6);
  }
}

}  // namespace
}  // namespace shallow_sand
