#include <gtest/gtest.h>

#include "closed_solutions.h"
#include "figures.h"
#include "scene_run.h"

namespace shallow_sand {
namespace {

const std::vector<double> kTimes = {0.2, 0.4, 0.6};  // [s]

/// The cap as it slides, one profile for each time.
std::vector<Profile> ours(const ParabolicCap& exact, const Scheme& scheme, double spacing) {
  SimulatorParameters parameters;
  parameters.backend = Backend::cpu;
  parameters.threads = 1;
  parameters.solver = scheme.parameters();
  parameters.grid.spacing = spacing;
  parameters.grid.size = {2.2, spacing};
  parameters.grid.origin = {-0.6, 0.0};
  parameters.material.friction_angle = std::atan(exact.friction);
  parameters.material.layer_depth = std::numeric_limits<double>::infinity();
  const Grid grid = parameters.grid.grid();
  std::vector<float> bed(grid.cells());
  std::vector<float> depth(grid.cells());
  for (int i = 0; i < grid.columns; ++i) {
    bed[grid.index(i, 0)] = static_cast<float>(-exact.slope * grid.x(i));
    depth[grid.index(i, 0)] = static_cast<float>(exact.depthAt(grid.x(i), 0.0));
  }
  Simulator simulator(parameters, bed, depth);
  std::vector<Profile> profiles;
  for (const double time : kTimes) {
    simulator.advance(time - simulator.time());
    profiles.push_back(profileOf(simulator));
  }
  return profiles;
}

Profile sampled(const ParabolicCap& exact, Profile like, double time) {
  for (std::size_t k = 0; k < like.x.size(); ++k) like.depth[k] = exact.depthAt(like.x[k], time);
  return like;
}

double centreOfMass(const Profile& profile) {
  double mass = 0.0;
  double moment = 0.0;
  for (std::size_t k = 0; k < profile.x.size(); ++k) {
    mass += profile.depth[k];
    moment += profile.depth[k] * profile.x[k];
  }
  return moment / mass;
}

/// Compares the cap of one scheme, at 1 cm, with what it should be.
void compare(FigureLog& log, const Scheme& scheme, const ParabolicCap& exact,
             const std::vector<Profile>& profiles) {
  for (std::size_t k = 0; k < kTimes.size(); ++k) {
    char time[8];
    std::snprintf(time, sizeof time, "%.1f", kTimes[k]);
    const double travelled = exact.centre(kTimes[k]);
    log.curve(std::string(time) + "_" + scheme.name, "x,depth", profiles[k].x, profiles[k].depth);
    const Profile closed = sampled(exact, profiles[k], kTimes[k]);
    log.curve(std::string(time) + "_reference", "x,depth", closed.x, closed.depth);
    log.near({scheme, "parabolic cap at " + std::string(time) + " s", "way of the centre of mass, 1 cm cells",
              "m", travelled, centreOfMass(profiles[k])},
             0.05 * travelled, "5 %");
  }
}

TEST(ParabolicCapTest, SlidesAndSpreadsAsSavageAndHutterFound) {
  FigureLog log("parabolic_cap");
  const ParabolicCap exact;
  const std::vector<double> spacings = {0.02, 0.01, 0.005, 0.0025};
  for (const Scheme& scheme : kSchemes) {
    std::vector<double> errors;
    for (const double spacing : spacings) {
      const std::vector<Profile> profiles = ours(exact, scheme, spacing);
      errors.push_back(relativeDifference(profiles.back(), sampled(exact, profiles.back(), kTimes.back())));
      if (spacing == 0.01) compare(log, scheme, exact, profiles);
    }
    log.converges(scheme, "parabolic cap at 0.6 s", "depth, relative L1 error", spacings, errors);
  }
}

}  // namespace
}  // namespace shallow_sand
