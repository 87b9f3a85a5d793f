#include <gtest/gtest.h>

#include "closed_solutions.h"
#include "figures.h"
#include "scene_run.h"

namespace shallow_sand {
namespace {

constexpr double kTime = 0.25;  // [s]

/// Sand between x = -0.5 m, which what happens at the upper edge does not reach, and x = 1 m.
Profile ours(const DamBreakSolution& exact, const Scheme& scheme, double spacing) {
  SimulatorParameters parameters;
  parameters.backend = Backend::cpu;
  parameters.threads = 1;
  parameters.solver = scheme.parameters();
  parameters.grid.spacing = spacing;
  parameters.grid.size = {2.0, spacing};
  parameters.grid.origin = {-1.0, 0.0};
  parameters.material.friction_angle = std::atan(exact.friction);
  parameters.material.layer_depth = std::numeric_limits<double>::infinity();
  parameters.edges.x_min = Edge::open;
  parameters.edges.x_max = Edge::open;
  const Grid grid = parameters.grid.grid();
  std::vector<float> bed(grid.cells());
  std::vector<float> depth(grid.cells());
  for (int i = 0; i < grid.columns; ++i) {
    bed[grid.index(i, 0)] = static_cast<float>(-exact.slope * grid.x(i));
    depth[grid.index(i, 0)] = grid.x(i) < 0.0 ? static_cast<float>(exact.depth) : 0.0f;
  }
  Simulator simulator(parameters, bed, depth);
  simulator.advance(kTime);
  const Profile whole = profileOf(simulator);
  Profile profile;
  for (std::size_t k = 0; k < whole.x.size(); ++k) {
    if (whole.x[k] < -0.5) continue;
    profile.x.push_back(whole.x[k]);
    profile.depth.push_back(whole.depth[k]);
  }
  return profile;
}

/// The exact depths at the samples of `like`.
Profile sampled(const DamBreakSolution& exact, Profile like) {
  for (std::size_t k = 0; k < like.x.size(); ++k) like.depth[k] = exact.depthAt(like.x[k], kTime);
  return like;
}

void validate(FigureLog& log, const std::string& name, const DamBreakSolution& exact) {
  const std::vector<double> spacings = {0.02, 0.01, 0.005, 0.0025};
  for (const Scheme& scheme : kSchemes) {
    std::vector<double> errors;
    for (const double spacing : spacings) {
      const Profile profile = ours(exact, scheme, spacing);
      errors.push_back(relativeDifference(profile, sampled(exact, profile)));
      if (spacing == 0.01)
        log.curve(std::string("profile_") + scheme.name, "x,depth", profile.x, profile.depth);
      if (spacing == 0.0025)
        log.curve("profile_reference", "x,depth", profile.x, sampled(exact, profile).depth);
    }
    log.converges(scheme, name, "depth at 0.25 s, relative L1 error", spacings, errors);
  }
}

TEST(DamBreak, WithoutFrictionOnAPlain) {
  FigureLog log("dam_break_plain");
  validate(log, "dam break without friction", {0.0, 0.0, 0.2});
}

TEST(DamBreak, OnAPlaneSteeperThanFrictionHolds) {
  FigureLog log("dam_break_slope");
  validate(log, "dam break, slope 0.3, μ 0.2", {0.3, 0.2, 0.2});
}

}  // namespace
}  // namespace shallow_sand
