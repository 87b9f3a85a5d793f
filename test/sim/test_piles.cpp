#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "random_fields.h"
#include "random_seed.h"
#include "shallow_sand/scene/simulation.h"
#include "surface_profile.h"

namespace shallow_sand {
namespace {

constexpr double kDegree = M_PI / 180.0;

TEST(Piles, ConeUnderTheFrictionAngleKeepsEveryBit) {
  Scene scene = loadScene(SHALLOW_SAND_SOURCE_DIR "/config/scenes/cone_at_rest.yaml");
  scene.parameters.backend = Backend::cpu;
  const std::vector<float> start = scene.depth;
  Simulator simulator = buildSimulator(scene);
  simulator.advance(scene.duration);
  EXPECT_EQ(simulator.time(), 20.0);
  EXPECT_TRUE(sameBits(simulator.fields().depth, start));
  EXPECT_EQ(simulator.activeCells(), 0u);
  EXPECT_EQ(simulator.maxSpeed(), 0.0);
}

/// Sand that falls on bare ground at one place, at a random rate and not on the middle of a cell.
struct PouredPile {
  SimulatorParameters parameters;
  Pour pour;
};

/// Its foot will be 0.7 m from its middle, if its flanks stand at the friction angle; the walls are 1 m away.
PouredPile randomPile(std::mt19937& random, double friction_angle) {
  PouredPile pile;
  pile.parameters.grid.size = {2.0, 2.0};
  pile.parameters.grid.spacing = 0.02;
  pile.parameters.grid.origin = {-1.0, -1.0};
  pile.parameters.material.friction_angle = friction_angle;
  pile.parameters.backend = Backend::cpu;
  pile.pour.position = {uniform(random, -0.01, 0.01), uniform(random, -0.01, 0.01)};
  pile.pour.radius = uniform(random, 0.06, 0.1);
  const double foot = 0.7;
  const double volume = M_PI / 3.0 * foot * foot * foot * std::tan(friction_angle);
  pile.pour.stop = uniform(random, 8.0, 16.0);
  pile.pour.rate = volume / pile.pour.stop;
  return pile;
}

/// Ends when all sand rests.
void runToRest(Simulator& simulator, double pour_ends) {
  simulator.advance(pour_ends);
  const double latest = pour_ends + 10.0;
  while (simulator.activeCells() > 0) {
    ASSERT_LT(simulator.time(), latest) << simulator.activeCells() << " cells still move";
    simulator.advance(0.1);
  }
}

TEST(Piles, PouredSandRestsAtTheFrictionAngleAlikeInAllDirections) {
  std::mt19937 random = seededGenerator();
  for (const double friction_angle : {15.0, 30.0, 45.0, 60.0}) {
    SCOPED_TRACE(friction_angle);
    const PouredPile pile = randomPile(random, friction_angle * kDegree);
    const std::vector<float> bare(pile.parameters.grid.grid().cells(), 0.0f);
    Simulator simulator(pile.parameters, bare, bare);
    simulator.addPour(pile.pour);
    ASSERT_NO_FATAL_FAILURE(runToRest(simulator, pile.pour.stop));

    const Fields fields = simulator.fields();
    std::printf("friction %.0f deg, %.4f m^3/s on a radius of %.3f m, at rest %.1f s after the pour; flanks:",
                friction_angle, pile.pour.rate, pile.pour.radius, simulator.time() - pile.pour.stop);
    double gentlest = 90.0;
    double steepest = 0.0;
    for (int direction = 0; direction < 8; ++direction) {
      const double heading = direction * 22.5 * kDegree;
      const double flank = flankAngle(simulator.grid(), fields, pile.pour.position,
                                      {std::cos(heading), std::sin(heading)}, 0.0) /
                           kDegree;
      std::printf(" %.2f", flank);
      gentlest = std::min(gentlest, flank);
      steepest = std::max(steepest, flank);
    }
    std::printf("\n");
    EXPECT_GT(gentlest, friction_angle - 3.5);
    EXPECT_LT(steepest, friction_angle + 0.5);
    EXPECT_LT(steepest - gentlest, 1.0);
    EXPECT_LT(simulator.ledger().error(), 1e-6);
    EXPECT_NEAR(simulator.ledger().poured, pile.pour.rate * pile.pour.stop, 1e-3 * simulator.ledger().poured);
  }
}

}  // namespace
}  // namespace shallow_sand
