#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "coupling/bodies_in_sand.h"

namespace shallow_sand {
namespace {

// All lengths are whole numbers of the coarsest cells, so that every grid sees the same blade.
constexpr double kCoarsest = 0.08;
constexpr double kSurface = 0.32;
constexpr double kCut = 0.1;
constexpr double kThickness = 0.16;
constexpr double kWidth = 0.96;
constexpr double kTravel = 0.96;
constexpr double kSpeed = 0.1;
constexpr double kStart = 0.56;
constexpr double kMiddle = 0.96;

struct Volumes {
  double trench;  ///< missing below the old surface, where sand flows into it: behind the blade [m³]
  double berm;    ///< above the old surface, in front of the blade [m³]
  double aside;   ///< the same, left and right of its way [m³]
};

Volumes volumesOf(const Grid& grid, const Fields& fields) {
  Volumes volumes{0.0, 0.0, 0.0};
  const double front = kStart + kTravel + 0.5 * kThickness;
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      const double rise = fields.surface(grid.index(i, j)) - kSurface;
      if (rise < 0.0) volumes.trench -= rise * grid.cellArea();
      if (rise > 0.0) (grid.x(i) > front ? volumes.berm : volumes.aside) += rise * grid.cellArea();
    }
  }
  return volumes;
}

Volumes simulate(double spacing) {
  Scene scene = levelSand({2.56, 1.92}, spacing, kSurface);
  const Eigen::Vector3d from(kStart, kMiddle, kSurface - kCut + 0.4);
  SceneBody blade;
  blade.name = "blade";
  blade.shape = Box{{kThickness, kWidth, 0.8}};
  blade.motion = straightMotion(from, from + Eigen::Vector3d(kTravel, 0.0, 0.0), kSpeed);
  carve(scene, blade, kSurface - kCut, {kThickness, kWidth});
  scene.bodies = {blade};
  Simulator simulator = buildSimulator(scene);
  simulator.advanceTo(kTravel / kSpeed);
  EXPECT_LT(simulator.ledger().error(), 1e-6);
  EXPECT_LT(simulator.bodyOverlap(), 0.01 * kThickness * kWidth * kCut);
  return volumesOf(simulator.grid(), simulator.fields());
}

TEST(Spacing, ChangesTrenchAndBermLittle) {
  std::array<Volumes, 4> volumes;
  for (std::size_t level = 0; level < volumes.size(); ++level) {
    const double spacing = kCoarsest / static_cast<double>(1 << level);
    volumes[level] = simulate(spacing);
    std::printf("spacing %.3f m: trench %.5f m^3, berm in front %.5f, aside %.5f\n", spacing,
                volumes[level].trench, volumes[level].berm, volumes[level].aside);
  }
  // Single avalanches in the berm make more than what is left to converge between the two finest.
  const auto spread = [&](double Volumes::*part) {
    const auto [least, most] =
        std::minmax_element(volumes.begin(), volumes.end(),
                            [&](const Volumes& a, const Volumes& b) { return a.*part < b.*part; });
    return ((*most).*part - (*least).*part) / (volumes.back().*part);
  };
  std::printf("spread: trench %.3f, berm %.3f, aside %.3f\n", spread(&Volumes::trench),
              spread(&Volumes::berm), spread(&Volumes::aside));
  EXPECT_LT(spread(&Volumes::trench), 0.05);
  EXPECT_LT(spread(&Volumes::berm), 0.1);
}

}  // namespace
}  // namespace shallow_sand
