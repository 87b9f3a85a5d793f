#include <gtest/gtest.h>

#include "figures.h"
#include "scene_run.h"

namespace shallow_sand {
namespace {

constexpr double kRadius = 0.2;  // of the cylinder, r₀ [m]

/// A cylinder a times as high as its radius.
struct Cylinder {
  double a;
  bool dilute;  ///< the layer that flows is min(0.8 h, a quarter of the height), as in the paper's flume

  double height() const { return a * kRadius; }
  std::string name() const {
    char text[80];
    std::snprintf(text, sizeof text, "cylinder, a = %g, %s", a,
                  dilute ? "layer min(0.8 h, h₀/4)" : "layer = whole depth");
    return text;
  }
  YAML::Node scene(double spacing) const {
    YAML::Node scene = sceneFile("cylinder");
    scene["grid"]["spacing"] = spacing;
    scene["grid"]["size"][0] = 0.6 + 0.4 * a;
    scene["grid"]["size"][1] = 0.6 + 0.4 * a;
    scene["sand"][0]["cylinder"]["depth"] = height();
    if (dilute) {
      scene["material"]["dilute_layer"]["fraction"] = 0.8;
      scene["material"]["dilute_layer"]["depth"] = 0.25 * height();
    }
    return scene;
  }
  /// How far sand ran that is `part` of the cylinder's height deep, in radii of the cylinder.
  double runout(const Profile& deposit, double part) const {
    return deposit.reach(part * height()) / kRadius - 1.0;
  }
};

Profile reference(const Cylinder& cylinder) {
  LagrangianLaw law = lawOf(simulatorOf(cylinder.scene(0.02)));
  law.around_axis = true;
  LagrangianSand sand(
      law, gradedNodes(0.0, kRadius, 400), [&](double) { return cylinder.height(); }, true, false);
  EXPECT_TRUE(sand.advanceToRest(5.0));
  return sand.profile();
}

/// Depth over the distance from the axis, along the diagonal of the grid.
Profile diagonalOf(const Simulator& simulator) {
  const Fields fields = simulator.fields();
  const Grid& grid = simulator.grid();
  Profile profile;
  for (int i = 0; i < std::min(grid.columns, grid.rows); ++i) {
    profile.x.push_back(std::hypot(grid.x(i), grid.y(i)));
    profile.depth.push_back(fields.depth[grid.index(i, i)]);
  }
  return profile;
}

/// Σ|h − h_reference| / Σ h_reference over all cells.
double relativeDifference(const Simulator& simulator, const Profile& reference) {
  const Fields fields = simulator.fields();
  const Grid& grid = simulator.grid();
  double error = 0.0;
  double total = 0.0;
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      const double h = reference.at(std::hypot(grid.x(i), grid.y(j)));
      error += std::abs(fields.depth[grid.index(i, j)] - h);
      total += h;
    }
  }
  return error / total;
}

class CylinderCollapse : public ::testing::Test {
 protected:
  static FigureLog& log() {
    static FigureLog log("cylinder");
    return log;
  }

  void validate(const Cylinder& cylinder) {
    const Profile exact = reference(cylinder);
    const std::vector<double> spacings = {0.02, 0.01, 0.005};
    std::vector<double> errors;
    for (const double spacing : spacings) {
      Simulator simulator = simulatorOf(cylinder.scene(spacing));
      runToRest(simulator, 3.0);
      errors.push_back(relativeDifference(simulator, exact));
      const Profile along = profileOf(simulator);
      const Profile diagonal = diagonalOf(simulator);
      std::printf(
          "%s, spacing %.4f m: run-out at 5 %% %.3f (diagonal %.3f), at 1 %% %.3f (%.3f), middle %.4f; exact "
          "%.3f %.3f %.4f\n",
          cylinder.name().c_str(), spacing, cylinder.runout(along, 0.05), cylinder.runout(diagonal, 0.05),
          cylinder.runout(along, 0.01), cylinder.runout(diagonal, 0.01), along.depth[0] / kRadius,
          cylinder.runout(exact, 0.05), cylinder.runout(exact, 0.01), exact.depth[0] / kRadius);
    }
    log().converges(cylinder.name(), "depth, relative L1 error", spacings, errors);
  }
};

TEST_F(CylinderCollapse, WholeDepthFlows) {
  for (const double a : {0.25, 0.5, 1.0, 2.0}) validate({a, false});
}

TEST_F(CylinderCollapse, DiluteLayerFlows) {
  for (const double a : {0.25, 0.5, 1.0, 2.0}) validate({a, true});
}

}  // namespace
}  // namespace shallow_sand
