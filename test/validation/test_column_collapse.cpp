#include <gtest/gtest.h>

#include "figures.h"
#include "scene_run.h"

namespace shallow_sand {
namespace {

constexpr double kLength = 0.2;  // of the column, L₀ [m]

/// A column a times as high as it is long.
struct Column {
  double a;
  bool dilute;  ///< the layer that flows is min(0.8 h, a quarter of the height), as in the paper's flume

  double height() const { return a * kLength; }
  std::string name() const {
    char text[80];
    std::snprintf(text, sizeof text, "column, a = %g, %s", a,
                  dilute ? "layer min(0.8 h, h₀/4)" : "layer = whole depth");
    return text;
  }
  std::string file() const {
    return std::to_string(static_cast<int>(100.0 * a)) + (dilute ? "_dilute" : "_whole");
  }
  YAML::Node scene(double spacing) const {
    YAML::Node scene = channelFile("column", spacing);
    scene["grid"]["size"][0] = kLength * (1.0 + 4.0 * a);
    scene["sand"][0]["box"]["depth"] = height();
    if (dilute) {
      scene["material"]["dilute_layer"]["fraction"] = 0.8;
      scene["material"]["dilute_layer"]["depth"] = 0.25 * height();
    }
    return scene;
  }
  /// How far sand ran that is `part` of the column's height deep, in lengths of the column.
  double runout(const Profile& deposit, double part) const {
    return deposit.reach(part * height()) / kLength - 1.0;
  }
};

Profile ours(const Column& column, const Scheme& scheme, double spacing) {
  Simulator simulator = simulatorOf(column.scene(spacing), scheme);
  runToRest(simulator, 3.0);
  return profileOf(simulator);
}

Profile reference(const Column& column) {
  LagrangianSand sand(
      lawOf(column.scene(0.05 * column.height())), gradedNodes(0.0, kLength, 400),
      [&](double) { return column.height(); }, true, false);
  EXPECT_TRUE(sand.advanceToRest(5.0));
  return sand.profile();
}

class ColumnCollapse : public ::testing::Test {
 protected:
  static FigureLog& log() {
    static FigureLog log("column");
    return log;
  }

  void validate(const Column& column) {
    const Profile exact = reference(column);
    log().curve(column.file() + "_reference", "x,depth", exact.x, exact.depth);
    for (const Scheme& scheme : kSchemes) validate(column, scheme, exact);
  }

 private:
  /// With 20, 40 and 80 cells in the column's height.
  void validate(const Column& column, const Scheme& scheme, const Profile& exact) {
    std::vector<double> spacings;
    std::vector<double> errors;
    Profile deposit;
    for (const double cells : {20.0, 40.0, 80.0}) {
      spacings.push_back(column.height() / cells);
      deposit = ours(column, scheme, spacings.back());
      errors.push_back(relativeDifference(deposit, exact));
    }
    log().curve(column.file() + "_" + scheme.name, "x,depth", deposit.x, deposit.depth);
    log().converges(scheme, column.name(), "deposit, relative L1 error", spacings, errors);
    log().near({scheme, column.name(), "height at the wall / L₀", "", exact.depth.front() / kLength,
                deposit.depth.front() / kLength},
               0.02 * column.a, "2 % of h₀");
    for (const double part : {0.01, 0.05}) compareRunout(column, scheme, part, deposit, exact);
  }

  void compareRunout(const Column& column, const Scheme& scheme, double part, const Profile& deposit,
                     const Profile& exact) {
    const double runout = column.runout(exact, part);
    const std::string quantity =
        part == 0.01 ? "run-out / L₀, read at 1 % of h₀" : "run-out / L₀, read at 5 % of h₀";
    const Figure figure{scheme, column.name(), quantity, "", runout, column.runout(deposit, part)};
    // Sand 1 % of h₀ deep is less than a cell deep.
    if (part == 0.05) log().near(figure, 0.05 * runout, "5 %");
    const bool as_in_laboratories = log().compare(figure, 1.2 * column.a, 1.8 * column.a);
    // With a thinner layer, columns no higher than long run out as far as in laboratories.
    const bool must_be = part == 0.05 && column.dilute && column.a <= 1.0;
    EXPECT_TRUE(as_in_laboratories || !must_be) << column.name();
  }
};

const std::vector<double> kRatios = {0.25, 0.5, 1.0, 2.0};

TEST_F(ColumnCollapse, WholeDepthFlows) {
  for (const double a : kRatios) validate({a, false});
}

TEST_F(ColumnCollapse, DiluteLayerFlows) {
  for (const double a : kRatios) validate({a, true});
}

}  // namespace
}  // namespace shallow_sand
