#include <gtest/gtest.h>

#include "coupling/bodies_in_sand.h"

namespace shallow_sand {
namespace {

// The paper's figure 16: blades that turn about an upright axis.
constexpr double kSpacing = 0.02;
constexpr int kCells = 128;
constexpr double kSurface = 0.3;
constexpr double kCut = 0.1;
constexpr double kLayer = 10.0 * kSpacing;
constexpr double kLength = 1.2;  ///< of a pair of blades, tip to tip
constexpr double kThickness = 0.08;
constexpr double kHeight = 0.4;
constexpr double kRate = 0.5 * M_PI;  ///< [rad/s]
constexpr double kTurns = 2.0;
constexpr double kDuration = kTurns * 2.0 * M_PI / kRate;
constexpr double kMiddle = 0.5 * kCells * kSpacing;

SceneBody fanOf() {
  TriangleMesh mesh = triangulate(Box{{kLength, kThickness, kHeight}});
  mesh.append(triangulate(Box{{kThickness, kLength, kHeight}}), Eigen::Isometry3d::Identity());
  const Eigen::Vector3d place(kMiddle, kMiddle, kSurface - kCut + 0.5 * kHeight);
  SceneBody fan;
  fan.name = "fan";
  fan.shape = mesh;
  fan.motion = spinningMotion(place, place, kDuration, Eigen::Vector3d::UnitZ(), kRate);
  return fan;
}

double submerged() { return (2.0 * kLength - kThickness) * kThickness * kCut; }

/// Mean surface between two distances from the axis, above the old one. [m]
double meanRise(const Grid& grid, const Fields& fields, double nearest, double farthest) {
  double sum = 0.0;
  int count = 0;
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      const double r = std::hypot(grid.x(i) - kMiddle, grid.y(j) - kMiddle);
      if (r < nearest || r >= farthest) continue;
      sum += fields.surface(grid.index(i, j)) - kSurface;
      count += 1;
    }
  }
  return sum / count;
}

/// Largest difference of the surface from itself turned by a quarter. [m]
double asymmetry(const Grid& grid, const Fields& fields) {
  double largest = 0.0;
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      const double own = fields.surface(grid.index(i, j));
      const double turned_by_quarter = fields.surface(grid.index(grid.columns - 1 - j, i));
      largest = std::max(largest, std::abs(own - turned_by_quarter));
    }
  }
  return largest;
}

TEST(Fan, DigsAPitAndRaisesARingAlikeInAllQuarters) {
  Scene scene = levelSand({kCells * kSpacing, kCells * kSpacing}, kSpacing, kSurface);
  scene.bodies = {fanOf()};
  scene.parameters.material.layer_depth = kLayer;
  Simulator simulator = buildSimulator(scene);
  const double most_overlap = runWatchingOverlap(simulator, kDuration, 40);
  const Grid& grid = simulator.grid();
  const Fields fields = simulator.fields();
  expectSoundSand(fields);

  const double tip = 0.5 * kLength;
  double ring = 0.0;
  double ring_at = 0.0;
  std::printf("mean rise of the surface, by distance from the axis:");
  for (double r = 0.0; r < kMiddle; r += 2.0 * kSpacing) {
    const double rise = meanRise(grid, fields, r, r + 2.0 * kSpacing);
    std::printf(" %.3f", rise);
    if (rise > ring) ring_at = r + kSpacing;
    ring = std::max(ring, rise);
  }
  const double pit = -meanRise(grid, fields, 0.0, tip - 4.0 * kSpacing);
  const double uneven = asymmetry(grid, fields);
  std::printf(
      "\npit %.4f m deep on the mean, ring %.4f m high at %.2f m, asymmetry %.1e m, overlap at most "
      "%.2f %%, volume error %.0e\n",
      pit, ring, ring_at, uneven, 100.0 * most_overlap / submerged(), simulator.ledger().error());
  EXPECT_GT(pit, 0.2 * kCut);
  EXPECT_LT(pit, 1.02 * kCut);
  EXPECT_GT(ring, 0.2 * kCut);
  EXPECT_NEAR(ring_at, tip, 0.3 * tip);
  EXPECT_LT(uneven, 0.05 * kCut);
  EXPECT_LT(most_overlap, 0.01 * submerged());
  EXPECT_LT(simulator.ledger().error(), 1e-6);
}

}  // namespace
}  // namespace shallow_sand
