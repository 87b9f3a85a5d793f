#include <gtest/gtest.h>

#include "coupling/bodies_in_sand.h"
#include "random_fields.h"

namespace shallow_sand {
namespace {

constexpr double kSpacing = 0.02;
constexpr double kFrictionAngle = 32.0;

TEST(SandOnBodies, SpillsOverABladeLowerThanItsBerm) {
  constexpr double kSurface = 0.3;
  constexpr double kCut = 0.1;
  constexpr double kAbove = 0.06;  ///< of the blade, over the old surface
  constexpr double kThickness = 0.06;
  constexpr double kTravel = 1.4;
  constexpr double kSpeed = 0.1;
  constexpr double kStart = 0.6;
  constexpr double kMiddle = 0.5;
  Scene scene = levelSand({3.0, 1.0}, kSpacing, kSurface);
  SceneBody blade;
  blade.name = "blade";
  // From wall to wall: what it cuts can only go over it.
  blade.shape = Box{{kThickness, 1.0, kCut + kAbove}};
  const Eigen::Vector3d from(kStart, kMiddle, kSurface - kCut + 0.5 * (kCut + kAbove));
  blade.motion = straightMotion(from, from + Eigen::Vector3d(kTravel, 0.0, 0.0), kSpeed);
  carve(scene, blade, kSurface - kCut, {kThickness, 1.0});
  scene.bodies = {blade};
  Simulator simulator = buildSimulator(scene);
  const double most_overlap = runWatchingOverlap(simulator, kTravel / kSpeed);
  const Grid& grid = simulator.grid();
  const Fields fields = simulator.fields();

  double crest = 0.0;
  double spilled = 0.0;
  int columns = 0;
  for (double x = kStart + 0.5 * kTravel; x < 2.9; x += kSpacing) {
    const double surface = surfaceAt(grid, fields, {x, kMiddle});
    crest = std::max(crest, surface - kSurface);
    if (x > kStart + kTravel - 0.3) continue;
    spilled += surface - (kSurface - kCut);
    columns += 1;
  }
  spilled /= columns;
  // A wedge at the friction angle as high as the blade is over the old surface: then it runs over.
  const double full_after = kAbove * kAbove / (2.0 * kCut * std::tan(kFrictionAngle * kDegree));
  std::printf(
      "full after %.3f m; crest %.3f m over the old surface, blade %.3f; trench filled by %.3f of %.3f "
      "m; overlap at most %.2f %%\n",
      full_after, crest, kAbove, spilled, kCut, 100.0 * most_overlap / (kThickness * 1.0 * kCut));
  // Sand lies on the blade no higher than a heap as long as the blade is thick, and its moving flank.
  EXPECT_LT(crest, 2.5 * kAbove);
  EXPECT_GT(crest, 0.5 * kAbove);
  EXPECT_GT(spilled, 0.7 * kCut);
  EXPECT_LT(spilled, 1.3 * kCut);
  EXPECT_LT(most_overlap, 0.05 * kThickness * kCut);
  EXPECT_LT(simulator.ledger().error(), 1e-6);
}

TEST(SandOnBodies, PileOnATableRestsInEveryBit) {
  constexpr double kSide = 1.2;
  constexpr double kHeight = 0.1;
  constexpr double kMiddle = 1.0;
  Scene scene = levelSand({2.0, 2.0}, kSpacing, 0.0);
  SceneBody table;
  table.name = "table";
  table.shape = Box{{kSide, kSide, kHeight}};
  table.motion = {poseKey(0.0, {kMiddle, kMiddle, 0.5 * kHeight})};
  scene.bodies = {table};
  Pour pour;
  pour.position = {kMiddle, kMiddle};
  pour.radius = 0.08;
  pour.stop = 4.0;
  const double foot = 0.4;  // of the heap, well within the table [m]
  pour.rate = M_PI / 3.0 * foot * foot * foot * std::tan(kFrictionAngle * kDegree) / pour.stop;
  scene.pours = {pour};
  Simulator simulator = buildSimulator(scene);
  simulator.advanceTo(pour.stop);
  const bool settles = settle(simulator, 10.0);
  const Grid& grid = simulator.grid();
  const Fields rest = simulator.fields();
  const double on_table = volumeWhere(grid, rest, [&](double x, double y) {
    return std::abs(x - kMiddle) < 0.5 * kSide && std::abs(y - kMiddle) < 0.5 * kSide;
  });
  const double poured = simulator.ledger().poured;
  const double flank = flankAngle(grid, rest, pour.position, {1.0, 0.0}, kHeight) / kDegree;
  std::printf("settled %d at %.1f s; on the table %.2f %% of what was poured; flank %.1f deg\n", settles,
              simulator.time(), 100.0 * on_table / poured, flank);
  ASSERT_TRUE(settles);
  EXPECT_NEAR(on_table, poured, 1e-5 * poured);
  EXPECT_EQ(simulator.bodyOverlap(), 0.0);
  EXPECT_NEAR(flank, kFrictionAngle - 1.5, 2.0);  // as poured piles rest on the bed: see test_piles
  EXPECT_EQ(simulator.activeCells(), 0u);
  simulator.advance(3.0);
  expectSameBits(simulator.fields(), rest);
}

/// A body is taken away: what lay on it falls, all of it.
TEST(SandOnBodies, FallsWhenTheBodyIsTakenAway) {
  Scene scene = levelSand({1.2, 1.2}, kSpacing, 0.15);
  SceneBody table;
  table.name = "table";
  table.shape = Box{{0.5, 0.5, 0.05}};
  table.motion = {poseKey(0.0, {0.6, 0.6, 0.2})};
  scene.bodies = {table};
  Pour pour;
  pour.position = {0.6, 0.6};
  pour.rate = 0.002;
  pour.stop = 1.0;
  scene.pours = {pour};
  Simulator simulator = buildSimulator(scene);
  simulator.advance(2.0);
  const double before = simulator.ledger().now;
  simulator.removeBody(0);
  const bool settles = settle(simulator, 10.0);
  const Fields fields = simulator.fields();
  for (std::size_t k = 0; k < fields.depth.size(); ++k)
    ASSERT_EQ(fields.allDepth(k), static_cast<double>(fields.depth[k])) << "sand hangs in the air";
  EXPECT_TRUE(settles);
  EXPECT_NEAR(simulator.ledger().now, before, 1e-6 * before);
}

}  // namespace
}  // namespace shallow_sand
