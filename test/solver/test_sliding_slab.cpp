#include <gtest/gtest.h>

#include <cstdio>

#include "random_fields.h"
#include "random_seed.h"
#include "shallow_sand/sim/engine.h"

namespace shallow_sand {
namespace {

/// Sand as deep everywhere, on a plain, that slides as fast everywhere. What the walls do does not reach the
/// middle before it has stopped.
struct Slab {
  double friction;
  double depth;        ///< [m]
  double layer_depth;  ///< of the layer that rubs [m]
  double speed;        ///< [m/s]
  double heading;      ///< [rad]
  bool with_slopes;

  /// Coulomb's law; a layer thinner than the slab brakes all of it. [m/s²]
  double deceleration() const { return friction * 9.81 * std::min(layer_depth, depth) / depth; }
};

constexpr double kStep = 1e-3;

EngineStart startOf(const Slab& slab) {
  GridParameters parameters;
  parameters.spacing = 0.02;
  parameters.size = {101 * 0.02, 99 * 0.02};
  Material material;
  material.friction_angle = std::atan(slab.friction);
  material.layer_depth = slab.layer_depth;
  EngineStart start{};
  start.grid = parameters.grid();
  start.sand = sandConstants(start.grid, {0.0, 0.0, -9.81}, material);
  const std::size_t cells = start.grid.cells();
  const auto everywhere = [&](double value) { return std::vector<float>(cells, static_cast<float>(value)); };
  start.fields = {everywhere(0.0), everywhere(slab.depth),
                  everywhere(slab.depth * slab.speed * std::cos(slab.heading)),
                  everywhere(slab.depth * slab.speed * std::sin(slab.heading))};
  start.with_slopes = slab.with_slopes;
  return start;
}

TEST(SlidingSlab, LosesSpeedByCoulombsLawAndStopsExactly) {
  std::mt19937 random = seededGenerator();
  for (int number = 0; number < 16; ++number) {
    Slab slab{};
    slab.friction = uniform(random, 0.5, 1.5);
    slab.depth = uniform(random, 0.03, 0.1);
    slab.layer_depth =
        number % 2 == 0 ? std::numeric_limits<double>::infinity() : uniform(random, 0.5, 1.0) * slab.depth;
    slab.speed = uniform(random, 0.2, 1.0);
    slab.heading = uniform(random, 0.0, 2.0 * M_PI);
    slab.with_slopes = number % 4 < 2;
    SCOPED_TRACE("slab " + std::to_string(number));
    const EngineStart start = startOf(slab);
    const std::unique_ptr<SteppedEngine> engine = makeHostEngine(start, 1, true, instructionSets().back());
    const std::size_t middle = start.grid.index(50, 49);
    const double stop = slab.speed / slab.deceleration();
    double rested = -1.0;
    for (int step = 1; step * kStep < stop + 10.0 * kStep; ++step) {
      engine->attempt(static_cast<float>(kStep));
      engine->accept();
      const Fields fields = engine->fields();
      const double x = fields.momentum_x[middle] / fields.depth[middle];
      const double y = fields.momentum_y[middle] / fields.depth[middle];
      const double expected = std::max(0.0, slab.speed - slab.deceleration() * step * kStep);
      // Roundings of a few hundred steps.
      ASSERT_NEAR(x, expected * std::cos(slab.heading),
                  1e-4 * slab.speed + 1e-3 * slab.deceleration() * kStep);
      ASSERT_NEAR(y, expected * std::sin(slab.heading),
                  1e-4 * slab.speed + 1e-3 * slab.deceleration() * kStep);
      if (rested < 0.0 && x == 0.0 && y == 0.0) rested = step * kStep;
    }
    EXPECT_NEAR(rested, stop, 1.1 * kStep);
  }
}

}  // namespace
}  // namespace shallow_sand
