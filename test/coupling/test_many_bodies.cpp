#include <gtest/gtest.h>

#include "coupling/bodies_in_sand.h"
#include "random_bodies.h"
#include "random_seed.h"

namespace shallow_sand {
namespace {

constexpr double kSpacing = 0.02;
constexpr double kSurface = 0.3;
constexpr double kCut = 0.1;

SceneBody boxOf(const std::string& name, const Eigen::Vector3d& size, std::vector<PoseKey> motion) {
  SceneBody box;
  box.name = name;
  box.shape = Box{size};
  box.motion = std::move(motion);
  return box;
}

TEST(ManyBodies, TwoHundredOnALargeMap) {
  std::mt19937 random = seededGenerator();
  constexpr int kSide = 1024;
  constexpr double kDuration = 0.08;
  const Scene scene = levelSand({kSide * kSpacing, kSide * kSpacing}, kSpacing, kSurface);
  Simulator simulator = buildSimulator(scene);
  double volume = 0.0;
  for (int number = 0; number < 200; ++number) {
    RandomBody body = randomBody(random, kSpacing);
    const Eigen::Vector2d from = randomPlace(random, simulator.grid(), body.radius);
    const double heading = uniform(random, -M_PI, M_PI);
    const double way = kDuration * uniform(random, 0.0, 1.0);
    const double height = kSurface + uniform(random, -0.5, 0.5) * body.radius;
    const Eigen::Quaterniond rotation = randomRotation(random);
    body.motion.push_back({0.0, poseOf(from, height, rotation)});
    const Eigen::Vector2d to = from + way * Eigen::Vector2d(std::cos(heading), std::sin(heading));
    body.motion.push_back({kDuration, poseOf(to, height, rotation)});
    addTo(simulator, body);
    volume += 4.0 / 3.0 * M_PI * std::pow(body.radius, 3);
  }
  simulator.advance(0.5 * kDuration);  // sand has left the places where bodies were put
  const double overlap_moving = runWatchingOverlap(simulator, kDuration, 2);
  simulator.advance(0.03);
  std::printf(
      "overlap at most %.2f %% of the balls around the bodies while they move, %.3f %% after; volume "
      "error %.0e; %d steps\n",
      100.0 * overlap_moving / volume, 100.0 * simulator.bodyOverlap() / volume, simulator.ledger().error(),
      static_cast<int>(simulator.progress().steps));
  expectSoundSand(simulator.fields());
  EXPECT_LT(simulator.ledger().error(), 1e-6);
  EXPECT_LT(overlap_moving, 0.01 * volume);
  EXPECT_LT(simulator.bodyOverlap(), 1e-3 * volume);
}

/// Sand that is covered all over has nowhere to go, and must be there when the body is lifted again.
TEST(ManyBodies, BodyLargerThanTheMapLosesNoSand) {
  Scene scene = levelSand({1.0, 0.8}, kSpacing, kSurface);
  const auto at = [](double time, double bottom) { return poseKey(time, {0.5, 0.4, bottom + 0.25}); };
  scene.bodies = {
      boxOf("lid", {3.0, 3.0, 0.5}, {at(0.0, kSurface + 0.05), at(1.0, kSurface - kCut), at(2.0, 1.0)})};
  Simulator simulator = buildSimulator(scene);
  simulator.advance(1.0);
  expectSoundSand(simulator.fields());
  EXPECT_LT(simulator.ledger().error(), 1e-6);
  simulator.advance(1.5);
  const Fields fields = simulator.fields();
  expectSoundSand(fields);
  EXPECT_LT(simulator.ledger().error(), 1e-6);
  EXPECT_EQ(simulator.bodyOverlap(), 0.0);
  for (std::size_t k = 0; k < fields.depth.size(); ++k)
    ASSERT_NEAR(fields.surface(k), kSurface, 1e-5) << "cell " << k;
}

/// A wall as broad as the map pushes all that is above the cut over the open edge.
TEST(ManyBodies, BodyBroaderThanTheMapPushesSandOverAnOpenEdge) {
  Scene scene = levelSand({1.6, 0.8}, kSpacing, kSurface);
  scene.parameters.edges.x_max = Edge::open;
  const Eigen::Vector3d from(0.1, 0.4, kSurface - kCut + 0.5);
  const double speed = 0.25;
  scene.bodies = {
      boxOf("wall", {0.2, 2.0, 1.0}, straightMotion(from, from + Eigen::Vector3d(2.0, 0.0, 0.0), speed))};
  carve(scene, scene.bodies.front(), kSurface - kCut, {0.2, 2.0});
  Simulator simulator = buildSimulator(scene);
  const double most_overlap = runWatchingOverlap(simulator, 1.3 / speed);  // its front reaches 1.5 m
  simulator.advanceTo(2.0 / speed + 1.0);
  const Fields fields = simulator.fields();
  expectSoundSand(fields);
  const double left_over = kSurface - kCut;
  double highest = 0.0;
  for (std::size_t k = 0; k < fields.depth.size(); ++k)
    highest = std::max(highest, fields.surface(k) - left_over);
  std::printf("overlap at most %.1e m^3, %.4f m^3 went over the edge, at most %.1e m above the cut is left\n",
              most_overlap, simulator.ledger().left, highest);
  // When it stops, what it has not yet pushed over the edge stands before it.
  EXPECT_GT(simulator.ledger().left, 0.8 * 1.4 * 0.8 * kCut);
  EXPECT_LT(most_overlap, 0.01 * 0.2 * 0.8 * kCut);
  EXPECT_LT(simulator.ledger().error(), 1e-6);
}

TEST(ManyBodies, BodyLeavesTheMapThroughAWall) {
  Scene scene = levelSand({1.6, 1.2}, kSpacing, kSurface);
  const Eigen::Vector3d from(0.4, 0.6, kSurface - kCut + 0.5);
  const double speed = 0.25;
  const double way = 2.0;
  scene.bodies = {
      boxOf("blade", {0.1, 0.4, 1.0}, straightMotion(from, from + Eigen::Vector3d(way, 0.0, 0.0), speed))};
  Simulator simulator = buildSimulator(scene);
  const double most_overlap = runWatchingOverlap(simulator, way / speed, 40);
  const bool settles = settle(simulator, 10.0);
  expectSoundSand(simulator.fields());
  std::printf("overlap at most %.2f %% of what is submerged, volume error %.0e, settled %d\n",
              100.0 * most_overlap / (0.1 * 0.4 * kCut), simulator.ledger().error(), settles);
  EXPECT_EQ(simulator.ledger().left, 0.0);
  EXPECT_LT(most_overlap, 0.01 * 0.1 * 0.4 * kCut);
  EXPECT_EQ(simulator.bodyOverlap(), 0.0);
  EXPECT_LT(simulator.ledger().error(), 1e-6);
  EXPECT_TRUE(settles);
}

TEST(ManyBodies, TwoInOneColumnKeepSandOutOfBoth) {
  Scene scene = levelSand({1.6, 1.2}, kSpacing, kSurface);
  const double speed = 0.2;
  const auto motion = [&](double middle) {
    const Eigen::Vector3d from(0.4, 0.6, middle);
    return straightMotion(from, from + Eigen::Vector3d(0.6, 0.0, 0.0), speed);
  };
  // Sand up to 0.3 m: around the lower box, and in the lower part of the upper one.
  scene.bodies = {boxOf("lower", {0.2, 0.4, 0.08}, motion(0.14)),
                  boxOf("upper", {0.2, 0.4, 0.4}, motion(0.44))};
  Simulator simulator = buildSimulator(scene);
  const double submerged = 0.2 * 0.4 * (0.08 + kSurface - 0.24);
  simulator.advance(0.2);
  const double most_overlap = runWatchingOverlap(simulator, 0.6 / speed);
  settle(simulator, 5.0);
  expectSoundSand(simulator.fields());
  std::printf("overlap at most %.2f %%, at rest %.2f %% of both; volume error %.0e\n",
              100.0 * most_overlap / submerged, 100.0 * simulator.bodyOverlap() / submerged,
              simulator.ledger().error());
  EXPECT_LT(most_overlap, 0.01 * submerged);
  EXPECT_LT(simulator.bodyOverlap(), 1e-3 * submerged);
  EXPECT_LT(simulator.ledger().error(), 1e-6);
}

TEST(ManyBodies, TwoThatCrossKeepSandOutOfBoth) {
  Scene scene = levelSand({1.6, 1.6}, kSpacing, kSurface);
  const double speed = 0.25;
  const double way = 0.8;
  const double middle = kSurface - kCut + 0.3;
  const Eigen::Vector3d east(0.4, 0.8, middle);
  const Eigen::Vector3d north(0.8, 0.4, middle);
  scene.bodies = {
      boxOf("east", {0.16, 0.24, 0.6}, straightMotion(east, east + Eigen::Vector3d(way, 0.0, 0.0), speed)),
      boxOf("north", {0.24, 0.16, 0.6},
            straightMotion(north, north + Eigen::Vector3d(0.0, way, 0.0), speed))};
  Simulator simulator = buildSimulator(scene);
  const double submerged = 2.0 * 0.16 * 0.24 * kCut;
  simulator.advance(0.2);
  const double most_overlap = runWatchingOverlap(simulator, way / speed, 40);
  settle(simulator, 5.0);
  expectSoundSand(simulator.fields());
  std::printf("overlap at most %.2f %%, at rest %.3f %% of both; volume error %.0e\n",
              100.0 * most_overlap / submerged, 100.0 * simulator.bodyOverlap() / submerged,
              simulator.ledger().error());
  EXPECT_LT(most_overlap, 0.05 * submerged);
  EXPECT_LT(simulator.bodyOverlap(), 1e-3 * submerged);
  EXPECT_LT(simulator.ledger().error(), 1e-6);
}

}  // namespace
}  // namespace shallow_sand
