#include <gtest/gtest.h>

#include "closed_solutions.h"
#include "figures.h"
#include "lagrangian_sand.h"

namespace shallow_sand {
namespace {

constexpr double kDegree = M_PI / 180.0;

/// ∫|h − exact| / ∫exact over the columns.
template <class Depth>
double relativeError(const LagrangianSand& sand, const Depth& exact) {
  const Profile profile = sand.profile();
  double error = 0.0;
  double total = 0.0;
  for (std::size_t k = 1; k + 1 < profile.x.size(); ++k) {
    const double length = 0.5 * (profile.x[k + 1] - profile.x[k - 1]);
    error += std::abs(profile.depth[k] - exact(profile.x[k])) * length;
    total += exact(profile.x[k]) * length;
  }
  return error / total;
}

TEST(ReferenceSolver, DamBreaks) {
  for (const DamBreakSolution& exact : {DamBreakSolution{0.0, 0.0, 0.2}, DamBreakSolution{0.3, 0.2, 0.2}}) {
    LagrangianLaw law;
    law.slope = exact.slope;
    law.friction = exact.friction;
    // The rear end is free and far away: what it does in this time stays behind x = -0.9 m.
    LagrangianSand sand(
        law, gradedNodes(-2.0, 0.0, 800), [&](double) { return exact.depth; }, false, false);
    sand.advance(0.25);
    const double error = relativeError(
        sand, [&](double x) { return x < -0.9 ? sand.profile().at(x) : exact.depthAt(x, sand.time()); });
    std::printf("dam break, slope %.1f, friction %.1f: relative L1 error %.5f\n", exact.slope, exact.friction,
                error);
    EXPECT_LT(error, 0.001);
  }
}

/// Whatever happens behind, the first grains slow down by friction alone, until they stop 2 h₀/μ ahead.
TEST(ReferenceSolver, TheToeObeysFrictionAlone) {
  LagrangianLaw law;
  law.friction = std::tan(30.9 * kDegree);
  LagrangianSand sand(
      law, gradedNodes(-0.4, 0.0, 400), [](double) { return 0.2; }, true, false);
  const double c = std::sqrt(law.gravity * 0.2);
  const double reach = 2.0 * 0.2 / law.friction;
  for (const double time : {0.1, 0.2, 0.3, 0.4}) {
    sand.advance(time - sand.time());
    const double exact = 2.0 * c * time - 0.5 * law.friction * law.gravity * time * time;
    std::printf("toe at %.1f s: exact %.4f m, reference %.4f m\n", time, exact, sand.front());
    EXPECT_NEAR(sand.front(), exact, 0.03 * reach);  // the outermost column is 0.1 mm wide at first, not 0
  }
}

TEST(ReferenceSolver, ParabolicCap) {
  const ParabolicCap exact;
  LagrangianLaw law;
  law.slope = exact.slope;
  law.friction = exact.friction;
  LagrangianSand sand(
      law, evenNodes(-exact.half_length, exact.half_length, 400),
      [&](double x) { return exact.depthAt(x, 0.0); }, false, false);
  for (const double time : {0.2, 0.4, 0.6}) {
    sand.advance(time - sand.time());
    const double error = relativeError(sand, [&](double x) { return exact.depthAt(x, time); });
    std::printf("parabolic cap at %.1f s: half length %.4f m, relative L1 error %.5f\n", time,
                exact.halfLength(time), error);
    EXPECT_LT(error, 0.005);
    EXPECT_NEAR(sand.front(), exact.centre(time) + exact.halfLength(time), 0.005);
  }
}

/// What another solver of these equations gave for the flume: finite volumes that keep slopes at rest, in
/// double precision, converged at 0.5 to 1 mm.
struct FlumeNumbers {
  double inclination;     ///< [°]
  double depth_at_wall;   ///< at the end [m]
  double front;           ///< at the end, where the sand is 5 cm deep [m]
  double furthest_front;  ///< ever [m]
};

TEST(ReferenceSolver, AgreesWithFiniteVolumesOnTheFlume) {
  for (const FlumeNumbers& other :
       {FlumeNumbers{0.0, 0.2, 0.515, 0.516}, {10.0, 0.2, 0.563, 0.565}, {20.0, 0.1471, 0.686, 0.696}}) {
    LagrangianLaw law;
    law.friction = std::tan(30.9 * kDegree);
    law.slope = std::tan(other.inclination * kDegree);
    LagrangianSand sand(
        law, gradedNodes(0.0, 0.4, 400), [](double) { return 0.2; }, true, false);
    double furthest = 0.0;
    while (sand.time() < 5.0 && !sand.advanceToRest(sand.time() + 0.01))
      furthest = std::max(furthest, sand.profile().reach(0.05));
    const Profile end = sand.profile();
    std::printf("flume, %.0f degrees: wall %.4f m, front %.4f m, furthest %.4f m\n", other.inclination,
                end.depth[0], end.reach(0.05), furthest);
    EXPECT_NEAR(end.depth[0], other.depth_at_wall, 0.001);
    EXPECT_NEAR(end.reach(0.05), other.front, 0.002);
    EXPECT_NEAR(furthest, other.furthest_front, 0.002);
  }
}

}  // namespace
}  // namespace shallow_sand
