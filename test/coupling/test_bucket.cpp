#include <gtest/gtest.h>

#include "coupling/bodies_in_sand.h"

namespace shallow_sand {
namespace {

constexpr double kSpacing = 0.02;
constexpr double kInside = 0.4;  ///< length and breadth [m]
constexpr double kDepth = 0.24;
constexpr double kWall = 0.06;
constexpr double kOutside = kInside + 2.0 * kWall;
constexpr double kPoured = 0.012;  ///< a third of what fits, level [m³]
constexpr double kPourEnds = 4.0;
constexpr double kCarriedFrom = 6.0;
constexpr double kCarriedTo = 10.0;
constexpr double kTippedAt = 12.0;
constexpr double kFromX = 0.8;
constexpr double kToX = 1.8;
constexpr double kMiddleY = 0.8;

/// An open box of five plates; its origin is in the middle of its floor's lower side.
TriangleMesh bucketMesh() {
  TriangleMesh mesh;
  const auto plate = [&](const Eigen::Vector3d& size, const Eigen::Vector3d& middle) {
    mesh.append(triangulate(Box{size}), Eigen::Isometry3d(Eigen::Translation3d(middle)));
  };
  const double side = 0.5 * (kInside + kWall);
  const double half_height = 0.5 * (kDepth + kWall);
  plate({kOutside, kOutside, kWall}, {0.0, 0.0, 0.5 * kWall});
  for (const double sign : {-1.0, 1.0}) {
    plate({kWall, kOutside, 2.0 * half_height}, {sign * side, 0.0, half_height});
    plate({kOutside, kWall, 2.0 * half_height}, {0.0, sign * side, half_height});
  }
  return mesh;
}

/// Stands on the bed, is lifted, carried a metre and tipped over by 150°.
std::vector<PoseKey> carryAndTip() {
  const double height = 0.4;
  std::vector<PoseKey> motion{
      poseKey(0.0, {kFromX, kMiddleY, 0.0}), poseKey(kPourEnds, {kFromX, kMiddleY, 0.0}),
      poseKey(kCarriedFrom, {kFromX, kMiddleY, height}), poseKey(kCarriedTo, {kToX, kMiddleY, height})};
  for (int part = 1; part <= 5; ++part) {
    const double time = kCarriedTo + (kTippedAt - kCarriedTo) * part / 5.0;
    const double angle = 150.0 * kDegree * part / 5.0;
    motion.push_back(poseKey(time, {kToX, kMiddleY, height}, turned(angle, Eigen::Vector3d::UnitY())));
  }
  return motion;
}

Scene bucketScene() {
  Scene scene = levelSand({3.2, 1.6}, kSpacing, 0.0);
  SceneBody bucket;
  bucket.name = "bucket";
  bucket.shape = bucketMesh();
  bucket.motion = carryAndTip();
  scene.bodies = {bucket};
  Pour pour;
  pour.position = {kFromX, kMiddleY};
  pour.radius = 0.08;
  pour.stop = kPourEnds - 1.0;
  pour.rate = kPoured / pour.stop;
  scene.pours = {pour};
  return scene;
}

/// Sand of the columns that the bucket covers while it stands upright; there is none below it. [m³]
double volumeAround(const Simulator& simulator, double x) {
  return volumeWhere(simulator.grid(), simulator.fields(), [x](double column_x, double column_y) {
    return std::abs(column_x - x) < 0.5 * kOutside && std::abs(column_y - kMiddleY) < 0.5 * kOutside;
  });
}

TEST(Bucket, CarriesSandAndTipsItOutWhereItIsTipped) {
  Simulator simulator = buildSimulator(bucketScene());
  simulator.advanceTo(kPourEnds);
  const double poured = simulator.ledger().poured;
  const double filled = volumeAround(simulator, kFromX);
  simulator.advanceTo(kCarriedFrom);
  const double lifted = volumeAround(simulator, kFromX);
  const double overlap = runWatchingOverlap(simulator, kCarriedTo);
  const double carried = volumeAround(simulator, kToX);
  const double left_behind = volumeAround(simulator, kFromX);
  simulator.advanceTo(kTippedAt + 2.0);
  const Fields end = simulator.fields();
  // Tipped over its edge, sand falls from the bucket's mouth, up to its length and depth ahead of its origin.
  const double arrived = volumeWhere(simulator.grid(), end, [](double x, double y) {
    return x > kToX - 0.5 * kOutside && x < kToX + 1.2 && std::abs(y - kMiddleY) < 0.75;
  });
  std::printf(
      "poured %.5f m^3; in the bucket %.1f %%, lifted %.1f %%, carried %.1f %% (left behind %.1f %%), "
      "arrived %.1f %%; overlap at most %.1e m^3, volume error %.0e\n",
      poured, 100.0 * filled / poured, 100.0 * lifted / poured, 100.0 * carried / poured,
      100.0 * left_behind / poured, 100.0 * arrived / poured, overlap, simulator.ledger().error());
  expectSoundSand(end);
  EXPECT_NEAR(poured, kPoured, 1e-3 * kPoured);
  EXPECT_GT(filled, 0.99 * poured);
  EXPECT_GT(lifted, 0.95 * poured);
  EXPECT_GT(carried, 0.9 * poured);
  EXPECT_GT(arrived, 0.9 * poured);
  EXPECT_LT(overlap, 0.01 * poured);
  EXPECT_LT(simulator.ledger().error(), 1e-6);
}

/// Nothing of the sand may lie below the bucket while it is carried.
TEST(Bucket, LetsNothingThroughItsFloor) {
  Simulator simulator = buildSimulator(bucketScene());
  simulator.advanceTo(0.5 * (kCarriedFrom + kCarriedTo));
  const Fields fields = simulator.fields();
  double on_bed = 0.0;
  for (const float depth : fields.depth) on_bed += static_cast<double>(depth);
  on_bed *= simulator.grid().cellArea();
  std::printf("on the bed: %.1f %% of what was poured\n", 100.0 * on_bed / simulator.ledger().poured);
  EXPECT_LT(on_bed, 0.05 * simulator.ledger().poured);
}

/// A bucket without front plate, driven into sand, filled by what it pushes into itself, and lifted.
TEST(Bucket, DigsAndLiftsWhatItDug) {
  constexpr double kSurface = 0.3;
  constexpr double kCut = 0.1;
  constexpr double kSpeed = 0.2;
  constexpr double kTravel = 0.4;
  TriangleMesh mesh;
  const auto plate = [&](const Eigen::Vector3d& size, const Eigen::Vector3d& middle) {
    mesh.append(triangulate(Box{size}), Eigen::Isometry3d(Eigen::Translation3d(middle)));
  };
  plate({kOutside, kOutside, kWall}, {0.0, 0.0, 0.5 * kWall});
  plate({kWall, kOutside, 0.6}, {-0.5 * (kInside + kWall), 0.0, 0.3});
  plate({kOutside, kWall, 0.6}, {0.0, -0.5 * (kInside + kWall), 0.3});
  plate({kOutside, kWall, 0.6}, {0.0, 0.5 * (kInside + kWall), 0.3});
  const double low = kSurface - kCut - kWall;
  const double dug_at = kTravel / kSpeed;
  SceneBody scoop;
  scoop.name = "scoop";
  scoop.shape = mesh;
  // It comes down ahead of the sand, in a pit that is dug beforehand.
  scoop.motion = {poseKey(0.0, {0.5, kMiddleY, low}), poseKey(dug_at, {0.5 + kTravel, kMiddleY, low}),
                  poseKey(dug_at + 3.0, {0.5 + kTravel, kMiddleY, low + 0.6})};
  Scene scene = levelSand({2.4, 1.6}, kSpacing, kSurface);
  const Grid grid = scene.parameters.grid.grid();
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      if (grid.x(i) < 0.5 + 0.5 * kOutside) scene.depth[grid.index(i, j)] = static_cast<float>(low);
    }
  }
  scene.bodies = {scoop};
  Simulator simulator = buildSimulator(scene);
  simulator.advanceTo(dug_at + 3.0);
  const Fields lifted = simulator.fields();
  double above_bed = 0.0;
  for (std::size_t k = 0; k < grid.cells(); ++k)
    above_bed += lifted.allDepth(k) - static_cast<double>(lifted.depth[k]);
  above_bed *= grid.cellArea();
  const double mouthful = kTravel * kInside * kCut;
  std::printf("lifted %.5f m^3; its floor passed under %.5f\n", above_bed, mouthful);
  // The mouth is open: sand slides out again until the heap's foot is at the floor's edge.
  EXPECT_GT(above_bed, 0.5 * mouthful);
  EXPECT_LT(simulator.ledger().error(), 1e-6);
}

}  // namespace
}  // namespace shallow_sand
