#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "random_fields.h"
#include "shallow_sand/scene/simulation.h"
#include "surface_profile.h"

namespace shallow_sand {
namespace {

// What config/scenes/blade.yaml says.
constexpr double kSurface = 0.3;
constexpr double kCut = 0.1;
constexpr double kStartsAt = 0.55;  ///< x of the blade's rear face
constexpr double kEndsAt = 2.15;
constexpr double kThickness = 0.1;
constexpr double kWidth = 1.0;
constexpr double kMiddle = 1.0;  ///< y
constexpr double kStops = 8.0;
constexpr double kFrictionAngle = 32.0;
constexpr double kSubmerged = kThickness * kWidth * kCut;

Scene bladeScene() {
  Scene scene = loadScene(SHALLOW_SAND_SOURCE_DIR "/config/scenes/blade.yaml");
  scene.parameters.backend = Backend::cpu;
  return scene;
}

/// Slope of the berm in front of the blade's last place. [degrees]
double bermAngle(const Grid& grid, const Fields& fields) {
  Eigen::Vector2d top(kEndsAt + kThickness + 0.5 * grid.spacing, kMiddle);
  for (Eigen::Vector2d here = top; here.x() < grid.x(grid.columns - 1); here.x() += grid.spacing) {
    if (surfaceAt(grid, fields, here) > surfaceAt(grid, fields, top)) top = here;
  }
  return flankAngle(grid, fields, top, {1.0, 0.0}, kSurface) * 180.0 / M_PI;
}

TEST(Blade, CutsATrenchAndPushesABerm) {
  const Scene scene = bladeScene();
  Simulator simulator = buildSimulator(scene);
  simulator.advance(0.5 * kStops);
  const double overlap_moving = simulator.bodyOverlap();
  EXPECT_LT(overlap_moving, 0.01 * kSubmerged);
  simulator.advance(0.5 * kStops);
  const double berm = bermAngle(simulator.grid(), simulator.fields());
  EXPECT_NEAR(berm, kFrictionAngle, 3.5);
  simulator.advance(scene.duration - kStops);
  const double overlap_end = simulator.bodyOverlap();
  EXPECT_LT(overlap_end, 0.01 * kSubmerged);
  EXPECT_LT(simulator.ledger().error(), 1e-6);
  const Grid& grid = simulator.grid();
  const Fields fields = simulator.fields();

  // The walls of the trench slump; where they do not reach, its ground is as the blade left it.
  const double slump = 2.0 * kCut / std::tan(kFrictionAngle * M_PI / 180.0);
  double shallowest = kSurface;
  double deepest = 0.0;
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      const double depth_of_trench = kSurface - static_cast<double>(fields.depth[grid.index(i, j)]);
      if (std::abs(grid.y(j) - kMiddle) < 0.5 * kWidth - slump && grid.x(i) > kStartsAt + slump &&
          grid.x(i) < kEndsAt) {
        shallowest = std::min(shallowest, depth_of_trench);
        deepest = std::max(deepest, depth_of_trench);
      }
      if (grid.x(i) < kStartsAt - slump) {
        ASSERT_EQ(fields.depth[grid.index(i, j)], scene.depth[grid.index(i, j)])
            << "sand came behind the blade at " << grid.x(i) << ", " << grid.y(j);
      }
    }
  }
  EXPECT_GT(shallowest, 0.98 * kCut);
  EXPECT_LT(deepest, 1.02 * kCut);

  for (int second = 0; second < 10 && simulator.activeCells() > 0; ++second) simulator.advance(1.0);
  EXPECT_EQ(simulator.activeCells(), 0u);

  std::printf("trench %.5f to %.5f m deep; overlap %.2e (moving) and %.2e m^3 (at rest) of %.2e\n",
              shallowest, deepest, overlap_moving, overlap_end, kSubmerged);
  std::printf("berm %.2f deg while it is pushed, %.2f at rest; volume error %.1e; at rest after %.1f s\n",
              berm, bermAngle(grid, simulator.fields()), simulator.ledger().error(), simulator.time());
}

}  // namespace
}  // namespace shallow_sand
