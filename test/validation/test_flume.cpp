#include <gtest/gtest.h>

#include "figures.h"
#include "scene_run.h"

namespace shallow_sand {
namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr double kLength = 0.4;       // of the block [m]
constexpr double kDepth = 0.2;        // of the block [m]
constexpr double kFrontDepth = 0.05;  // at which the paper reads the front [m]
constexpr double kToeDepth = 0.01;    // 5 % of the block's depth [m]

/// One of the paper's runs.
struct Flume {
  double inclination;  ///< [°]
  bool dilute;         ///< the layer that flows is min(0.8 h, 0.05 m), not the whole depth

  std::string name() const {
    char text[80];
    std::snprintf(text, sizeof text, "flume at %.0f°, %s", inclination,
                  dilute ? "layer min(0.8 h, 5 cm)" : "layer = whole depth");
    return text;
  }
  std::string file() const {
    return std::to_string(static_cast<int>(inclination)) + (dilute ? "_dilute" : "_whole");
  }
  YAML::Node scene(double spacing) const {
    YAML::Node scene = channelFile("flume", spacing);
    scene["bed"]["slope"][0] = -std::tan(inclination * kDegree);
    if (dilute) {
      scene["material"]["dilute_layer"]["fraction"] = 0.8;
      scene["material"]["dilute_layer"]["depth"] = 0.05;
    }
    return scene;
  }
};

/// What is read off a run.
struct Deposit {
  Profile profile;            ///< at the end
  std::vector<double> time;   ///< [s]
  std::vector<double> front;  ///< where the sand is 5 cm deep, at each time [m]
};

Deposit ours(const Flume& flume, double spacing) {
  Simulator simulator = simulatorOf(flume.scene(spacing));
  Deposit deposit;
  runToRest(simulator, 3.0, [&] {
    deposit.time.push_back(simulator.time());
    deposit.front.push_back(profileOf(simulator).reach(kFrontDepth));
  });
  deposit.profile = profileOf(simulator);
  return deposit;
}

Deposit reference(const Flume& flume) {
  LagrangianSand sand(
      lawOf(simulatorOf(flume.scene(0.01))), gradedNodes(0.0, kLength, 400), [](double) { return kDepth; },
      true, false);
  Deposit deposit;
  bool rests = false;
  while (!rests && sand.time() < 3.0) {
    rests = sand.advanceToRest(sand.time() + 0.01);
    deposit.time.push_back(sand.time());
    deposit.front.push_back(sand.profile().reach(kFrontDepth));
  }
  EXPECT_TRUE(rests);
  deposit.profile = sand.profile();
  return deposit;
}

class FlumeTest : public ::testing::Test {
 protected:
  static FigureLog& log() {
    static FigureLog log("flume");
    return log;
  }

  void validate(const Flume& flume) {
    const Deposit exact = reference(flume);
    log().curve(flume.file() + "_profile_reference", "x,depth", exact.profile.x, exact.profile.depth);
    log().curve(flume.file() + "_front_reference", "time,front", exact.time, exact.front);
    const double front = exact.profile.reach(kFrontDepth);
    const double runout = exact.profile.reach(kToeDepth) - kLength;

    const std::vector<double> spacings = {0.01, 0.005, 0.0025};
    std::vector<double> errors;
    std::vector<double> runouts;
    for (const double spacing : spacings) {
      const Deposit deposit = ours(flume, spacing);
      errors.push_back(relativeDifference(deposit.profile, exact.profile));
      runouts.push_back(deposit.profile.reach(kToeDepth) - kLength);
      if (spacing != spacings.front()) continue;
      log().curve(flume.file() + "_profile_ours", "x,depth", deposit.profile.x, deposit.profile.depth);
      log().curve(flume.file() + "_front_ours", "time,front", deposit.time, deposit.front);
      log().near({flume.name(), "depth at the wall", "m", exact.profile.depth.front(),
                  deposit.profile.depth.front()},
                 0.02 * kDepth, "2 % of the block's depth");
      log().near({flume.name(), "front, 5 cm deep, at rest", "m", front, deposit.profile.reach(kFrontDepth)},
                 0.02, "two cells: the scheme smears fronts over two to three");
    }
    log().tell({flume.name(), "run-out, 1 cm deep, 1 cm cells", "m", runout, runouts.front()},
               "thin sand at the toe is smeared and slowed");
    log().near({flume.name(), "run-out, 1 cm deep, 2.5 mm cells", "m", runout, runouts.back()}, 0.05 * runout,
               "5 %");
    log().converges(flume.name(), "profile, relative L1 error", spacings, errors);
  }
};

TEST_F(FlumeTest, WholeDepthFlows) {
  for (const double inclination : {0.0, 10.0, 20.0}) validate({inclination, false});
}

TEST_F(FlumeTest, DiluteLayerFlows) {
  for (const double inclination : {0.0, 10.0, 20.0}) validate({inclination, true});
}

/// A grid that lies in the flume, with tilted gravity, must leave the same deposit as a sloping bed: the
/// equations differ by a factor of time alone.
TEST_F(FlumeTest, TiltedGravityLeavesTheDepositOfASlopingBed) {
  for (const double inclination : {10.0, 20.0}) {
    const Deposit sloping = ours({inclination, false}, 0.01);
    YAML::Node scene = Flume{0.0, false}.scene(0.01);
    scene["gravity"][0] = 9.81 * std::sin(inclination * kDegree);
    scene["gravity"][1] = 0.0;
    scene["gravity"][2] = -9.81 * std::cos(inclination * kDegree);
    Simulator tilted = simulatorOf(scene);
    runToRest(tilted, 3.0);
    const double difference = relativeDifference(profileOf(tilted), sloping.profile);
    std::printf(
        "flume at %.0f°: deposits in tilted gravity and on a sloping bed differ by %.2e, rest after %.2f s "
        "and %.2f s\n",
        inclination, difference, tilted.time(), sloping.time.back());
    EXPECT_LT(difference, 0.01);  // time steps fall elsewhere
  }
}

}  // namespace
}  // namespace shallow_sand
