#include <gtest/gtest.h>

#include "figures.h"
#include "scene_run.h"

namespace shallow_sand {
namespace {

/// Centre of mass of the sand in the row with the smallest y. [m]
struct Centre {
  double x;
  double z;
};

Centre centreOf(const Simulator& simulator) {
  const Fields fields = simulator.fields();
  double mass = 0.0;
  Centre sum{0.0, 0.0};
  for (int i = 0; i < simulator.grid().columns; ++i) {
    const std::size_t k = simulator.grid().index(i, 0);
    const double h = fields.depth[k];
    mass += h;
    sum.x += h * simulator.grid().x(i);
    sum.z += h * (fields.bed[k] + 0.5 * h);
  }
  return {sum.x / mass, sum.z / mass};
}

/// By how much more the sand's centre of mass fell than friction takes on its way: 0 if nothing but friction
/// (μ g times mass times way, where all sand moves forwards and its whole depth flows) takes energy.
double excessFall(const YAML::Node& scene, const Scheme& scheme) {
  Simulator simulator = simulatorOf(scene, scheme);
  const double friction = std::tan(simulator.parameters().material.friction_angle);
  const Centre start = centreOf(simulator);
  runToRest(simulator, 3.0);
  const Centre end = centreOf(simulator);
  return (start.z - end.z) / (friction * (end.x - start.x)) - 1.0;
}

TEST(EnergyLine, TheCentreOfMassFallsAlongTheFrictionAngle) {
  FigureLog log("energy_line");
  const std::vector<double> spacings = {0.01, 0.005, 0.0025, 0.00125};
  for (const Scheme& scheme : kSchemes) {
    for (const double inclination : {0.0, 10.0, 20.0}) {
      std::vector<double> excess;
      for (const double spacing : spacings) {
        YAML::Node scene = channelFile("flume", spacing);
        scene["bed"]["slope"][0] = -std::tan(inclination * M_PI / 180.0);
        excess.push_back(excessFall(scene, scheme));
        EXPECT_GT(excess.back(), 0.0) << "more energy than there was";
      }
      log.converges(scheme,
                    "flume at " + std::to_string(static_cast<int>(inclination)) + "°, layer = whole depth",
                    "energy lost beside friction", spacings, excess);
    }
  }
}

}  // namespace
}  // namespace shallow_sand
