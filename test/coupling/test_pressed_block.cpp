#include <gtest/gtest.h>

#include <array>

#include "coupling/bodies_in_sand.h"

namespace shallow_sand {
namespace {

constexpr double kSpacing = 0.02;
constexpr double kSurface = 0.3;
constexpr double kPressed = 0.14;
constexpr double kSide = 0.4;
constexpr double kHeight = 0.6;
constexpr double kSpeed = 0.05;
constexpr double kFriction = 0.62486935190932750978;  ///< tan 32°
const Eigen::Vector2d kMiddle{0.8, 0.8};
constexpr double kTakenUp = kSide * kSide * kPressed;  ///< by the block, below the old surface [m³]
constexpr double kDown = 0.02 + kPressed;              ///< way from the first pose to the lowest
constexpr double kPressedAt = kDown / kSpeed;          ///< [s]
constexpr double kLiftedFrom = kPressedAt + 4.0;
constexpr double kLiftedAt = kLiftedFrom + (kDown + 0.2) / kSpeed;

Scene blockScene() {
  Scene scene = levelSand({1.6, 1.6}, kSpacing, kSurface);
  const auto at = [](double time, double bottom) {
    return poseKey(time, {kMiddle.x(), kMiddle.y(), bottom + 0.5 * kHeight});
  };
  SceneBody block;
  block.name = "block";
  block.shape = Box{{kSide, kSide, kHeight}};
  block.motion = {at(0.0, kSurface + 0.02), at(kPressedAt, kSurface - kPressed),
                  at(kLiftedFrom, kSurface - kPressed), at(kLiftedAt, kSurface + 0.2)};
  scene.bodies = {block};
  return scene;
}

bool underBlock(double x, double y) {
  return std::abs(x - kMiddle.x()) < 0.5 * kSide && std::abs(y - kMiddle.y()) < 0.5 * kSide;
}

/// Height of a ring with a triangle as its section, upright where it leans on the block and as steep as
/// friction allows outside, that holds what the block displaced: along its sides prisms, around its corners
/// quarters of cones. [m]
double ringHeight() {
  const auto volume = [](double height) {
    return 4.0 * kSide * height * height / (2.0 * kFriction) +
           M_PI * height * height * height / (3.0 * kFriction * kFriction);
  };
  double low = 0.0;
  double high = kSurface;
  for (int halving = 0; halving < 50; ++halving) {
    const double middle = 0.5 * (low + high);
    (volume(middle) < kTakenUp ? low : high) = middle;
  }
  return low;
}

const std::array<Eigen::Vector2d, 4> kHeadings{Eigen::Vector2d{1.0, 0.0}, Eigen::Vector2d{-1.0, 0.0},
                                               Eigen::Vector2d{0.0, 1.0}, Eigen::Vector2d{0.0, -1.0}};

TEST(PressedBlock, DisplacesAsMuchAsItTakesUpAndRaisesARing) {
  Simulator simulator = buildSimulator(blockScene());
  const Grid& grid = simulator.grid();
  const Fields before = simulator.fields();
  const double most_inside = runWatchingOverlap(simulator, kPressedAt);
  const auto under = [](double x, double y) { return underBlock(x, y); };
  const auto displaced = [&] {
    return volumeWhere(grid, before, under) - volumeWhere(grid, simulator.fields(), under);
  };
  const double displaced_pressed = displaced();
  simulator.advanceTo(kLiftedFrom);
  const Fields pressed = simulator.fields();
  std::printf("inside at most %.2f %% of %.4f m^3, at rest %.2f %%; displaced %.2f %%, later %.2f %%\n",
              100.0 * most_inside / kTakenUp, kTakenUp, 100.0 * simulator.bodyOverlap() / kTakenUp,
              100.0 * displaced_pressed / kTakenUp, 100.0 * displaced() / kTakenUp);
  EXPECT_LT(most_inside, 0.01 * kTakenUp);
  EXPECT_LT(simulator.bodyOverlap(), 0.01 * kTakenUp);
  EXPECT_NEAR(displaced_pressed, kTakenUp, 0.01 * kTakenUp);
  EXPECT_NEAR(displaced(), kTakenUp, 0.01 * kTakenUp);
  EXPECT_LT(simulator.ledger().error(), 1e-6);

  double lowest = kSurface;
  double highest = 0.0;
  for (const Eigen::Vector2d& heading : kHeadings) {
    const Eigen::Vector2d foot = kMiddle + (0.5 * kSide + 0.5 * kSpacing) * heading;
    const Eigen::Vector2d top = highestOnLine(grid, pressed, foot, heading, 0.3);
    const double height = surfaceAt(grid, pressed, top) - kSurface;
    const double angle = flankAngle(grid, pressed, top, heading, kSurface) / kDegree;
    std::printf("ring %.4f m high (standing at 32 deg: %.4f m), %.3f m from the block, flank %.1f deg\n",
                height, ringHeight(), (top - foot).norm(), angle);
    lowest = std::min(lowest, height);
    highest = std::max(highest, height);
    EXPECT_NEAR(angle, 32.0, 3.0);
    // Before the middle of a side the ring is higher than on the mean: less of it goes to the corners.
    EXPECT_GT(height, 0.9 * ringHeight());
    EXPECT_LT(height, 1.3 * ringHeight());
  }
  EXPECT_LT(highest - lowest, 0.01 * highest);
}

TEST(PressedBlock, LeavesACraterWithWallsAtTheAngleOfRepose) {
  Simulator simulator = buildSimulator(blockScene());
  const Grid& grid = simulator.grid();
  runWatchingOverlap(simulator, kLiftedAt, 100);
  const bool settles = settle(simulator, 10.0);
  const Fields rest = simulator.fields();
  const double floor = surfaceAt(grid, rest, kMiddle);
  std::printf("settled %d at %.1f s; floor of the crater %.4f m below the old surface\n", settles,
              simulator.time(), kSurface - floor);
  EXPECT_TRUE(settles);
  EXPECT_GT(kSurface - floor, 0.25 * kPressed);
  EXPECT_LT(kSurface - floor, 1.01 * kPressed);
  for (const Eigen::Vector2d& heading : kHeadings) {
    const Eigen::Vector2d rim = highestOnLine(grid, rest, kMiddle, heading, 0.7);
    const double inner = flankAngle(grid, rest, rim, -heading, floor) / kDegree;
    std::printf("rim %.4f m over the old surface, %.2f m from the middle; walls %.1f deg inside\n",
                surfaceAt(grid, rest, rim) - kSurface, (rim - kMiddle).norm(), inner);
    expectSlopeAtRest(inner, 32.0);
    EXPECT_GT(surfaceAt(grid, rest, rim), kSurface);
  }
  EXPECT_EQ(simulator.bodyOverlap(), 0.0);
  EXPECT_LT(simulator.ledger().error(), 1e-6);
}

}  // namespace
}  // namespace shallow_sand
