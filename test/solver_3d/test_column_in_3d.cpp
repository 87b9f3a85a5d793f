#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "shallow_sand/scene/simulation.h"
#include "solver_3d/column_collapse.h"

namespace shallow_sand {
namespace {

/// How a column came to rest, by both solvers, on 24 cells of which its radius is 3.75.
struct Deposits {
  Column column;
  Profile in_3d;
  Profile on_map;

  explicit Deposits(double height) {
    column.height = height;
    column.layer = 0.25 * height;
    column.spacing = 1.28 / 24.0;
    column.youngs_modulus = 1e5;
    Simulator sand = buildSimulator(column.scene(1));
    MaterialPoints points = column.points(1);
    const double duration = 1.0;
    sand.advance(duration);
    points.advance(duration);
    EXPECT_LT(points.kineticEnergy(), 2e-3 * points.potentialEnergy()) << "it is not at rest";
    on_map = radialProfile(sand);
    in_3d = radialProfile(sand.grid(), points.depth());
    std::cout << "height " << height << " m: run-out " << runout(on_map) << " m, in 3-D " << runout(in_3d)
              << " m; deviation " << deviation() << '\n';
  }
  double runout(const Profile& profile) const { return profile.reach(0.05 * column.height); }
  double deviation() const { return relativeDeviation(on_map, in_3d); }
};

TEST(ColumnIn3d, LowColumnsComeToRestMoreAlikeThanTallOnes) {
  const Deposits low(0.2);
  const Deposits tall(0.8);
  EXPECT_NEAR(low.runout(low.on_map), low.runout(low.in_3d), 0.1 * low.runout(low.in_3d));
  EXPECT_LT(low.deviation(), 0.2);
  EXPECT_GT(tall.deviation(), low.deviation());
}

}  // namespace
}  // namespace shallow_sand
