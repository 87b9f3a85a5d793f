#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "shallow_sand/scene/simulation.h"
#include "shallow_sand/surface/surface_mesh.h"
#include "surface_profile.h"
#include "validation/profile.h"

namespace shallow_sand {
namespace {

constexpr double kDegree = M_PI / 180.0;

Scene sceneNamed(const std::string& name) {
  return loadScene(std::string(SHALLOW_SAND_SOURCE_DIR) + "/config/scenes/" + name + ".yaml");
}

/// How far the surface lies under `level` where a stick was drawn, at each pose in the sand but the ends of
/// strokes, where sand slides back, and those that it comes near again: nearer than `apart` later than a
/// second afterwards. [m]
std::vector<double> grooveDepths(const Simulator& sand, const SceneBody& stick, double half_length,
                                 double level, double apart) {
  const auto is_down = [&](const PoseKey& key) { return key.pose.translation().z() - half_length < level; };
  std::vector<PoseKey> drawing;
  for (std::size_t k = 0; k + 1 < stick.motion.size() && stick.motion[k].time <= sand.time(); ++k) {
    if (is_down(stick.motion[k]) && is_down(stick.motion[k + 1])) drawing.push_back(stick.motion[k]);
  }
  const Fields fields = sand.fields();
  std::vector<double> depths;
  for (const PoseKey& key : drawing) {
    const Eigen::Vector2d here = key.pose.translation().head<2>();
    const bool comes_again = std::any_of(drawing.begin(), drawing.end(), [&](const PoseKey& other) {
      return other.time > key.time + 1.0 && (other.pose.translation().head<2>() - here).norm() < apart;
    });
    if (!comes_again) depths.push_back(level - surfaceAt(sand.grid(), fields, here));
  }
  return depths;
}

double highest(const std::vector<double>& values) { return *std::max_element(values.begin(), values.end()); }
double lowest(const std::vector<double>& values) { return *std::min_element(values.begin(), values.end()); }

TEST(PaperScenes, ButterflyIsDrawnAndWipedFlat) {
  constexpr double kLevel = 0.2;
  constexpr double kTip = 0.02;  // under the surface
  const Scene scene = sceneNamed("butterfly");
  const double cell = scene.parameters.grid.spacing;
  Simulator sand = buildSimulator(scene);
  ASSERT_EQ(sand.grid().columns, 256);
  ASSERT_EQ(sand.grid().rows, 256);
  sand.advanceTo(30.0);
  const std::vector<double> grooves = grooveDepths(sand, scene.bodies[0], 0.15, kLevel, 0.3);
  std::cout << grooves.size() << " places: grooves from " << lowest(grooves) / cell << " to "
            << highest(grooves) / cell << " cells\n";
  ASSERT_GT(grooves.size(), 100u);
  for (const double depth : grooves) EXPECT_NEAR(depth, kTip, cell);

  sand.advanceTo(scene.duration);
  const Fields fields = sand.fields();
  double low = kLevel;
  double high = 0.0;
  for (double y = 0.3; y < 2.26; y += cell) {
    for (double x = 0.3; x < 2.1; x += cell) {
      const double z = surfaceAt(sand.grid(), fields, {x, y});
      low = std::min(low, z);
      high = std::max(high, z);
    }
  }
  std::cout << "wiped: level within " << (high - low) / cell << " cells\n";
  EXPECT_LT(high - low, cell);
  EXPECT_LT(sand.ledger().error(), 1e-6);
}

TEST(PaperScenes, WritingIsAsDeepAsItsStick) {
  const Scene scene = sceneNamed("writing");
  const double cell = scene.parameters.grid.spacing;
  Simulator sand = buildSimulator(scene);
  ASSERT_EQ(sand.grid().columns, 512);
  ASSERT_EQ(sand.grid().rows, 256);
  constexpr double kUntil = 12.0;  // the first character
  sand.advanceTo(kUntil);
  EXPECT_EQ(sand.progress().steps, std::lround(kUntil / 0.002));
  const std::vector<double> grooves = grooveDepths(sand, scene.bodies[0], 0.15, 0.15, 0.2);
  std::cout << grooves.size() << " places: grooves from " << lowest(grooves) / cell << " to "
            << highest(grooves) / cell << " cells\n";
  ASSERT_GT(grooves.size(), 5u);
  for (const double depth : grooves) EXPECT_NEAR(depth, 0.02, cell);
  EXPECT_LT(sand.ledger().error(), 1e-6);
}

TEST(PaperScenes, PilesRestAtTheirAngles) {
  const Scene scene = sceneNamed("piles");
  Simulator sand = buildSimulator(scene);
  sand.advanceTo(scene.duration);
  const Fields fields = sand.fields();
  const std::array<double, 4> angles{15.0, 30.0, 45.0, 60.0};
  for (std::size_t k = 0; k < angles.size(); ++k) {
    double mean = 0.0;
    for (int heading = 0; heading < 8; ++heading) {
      const double turn = heading * M_PI / 4.0;
      mean +=
          flankAngle(sand.grid(), fields, scene.pours[k].position, {std::cos(turn), std::sin(turn)}, 0.0) /
          8.0 / kDegree;
    }
    std::cout << "friction " << angles[k] << " degrees, flanks " << mean << "\n";
    EXPECT_NEAR(mean, angles[k], 1.5) << "degrees";
  }
  EXPECT_LT(sand.ledger().error(), 1e-6);
}

/// By how much the highest sand stands over the surface, in a ring of three cells around the block.
double bermAround(const Simulator& sand, const Eigen::Vector2d& middle, double half_side, double level) {
  const Grid& grid = sand.grid();
  const Fields fields = sand.fields();
  double berm = 0.0;
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      const double away =
          std::max(std::abs(grid.x(i) - middle.x()), std::abs(grid.y(j) - middle.y())) - half_side;
      if (away > 0.0 && away < 3.0 * grid.spacing)
        berm = std::max(berm, fields.surface(grid.index(i, j)) - level);
    }
  }
  return berm;
}

TEST(PaperScenes, PressedBlockRaisesABermByItsVerticalMotion) {
  for (const char* name : {"pressed_block", "pressed_block_flat"}) {
    const Scene scene = sceneNamed(name);
    Simulator sand = buildSimulator(scene);
    const Fields before = sand.fields();
    sand.advanceTo(scene.duration);
    const double berm = bermAround(sand, {0.8, 0.8}, 0.2, 0.3);
    std::cout << name << ": berm of " << 1000.0 * berm << " mm\n";
    if (scene.parameters.coupling == Coupling::drag) {
      EXPECT_GT(berm, 0.25 * scene.parameters.grid.spacing);
    } else {
      EXPECT_EQ(sand.fields().depth, before.depth) << "without it the sand stays as it was";
    }
    EXPECT_LT(sand.ledger().error(), 1e-6);
  }
}

/// Along the row at y.
Profile profileAlong(const Simulator& sand, const Fields& fields, double y) {
  const Grid& grid = sand.grid();
  const int row = static_cast<int>((y - grid.origin_y) / grid.spacing);
  Profile profile;
  for (int i = 0; i < grid.columns; ++i) {
    profile.x.push_back(grid.x(i));
    profile.depth.push_back(fields.depth[grid.index(i, row)]);
  }
  return profile;
}

TEST(PaperScenes, ThickerLayersRunFasterAndFarther) {
  const Scene scene = sceneNamed("layers");
  Simulator sand = buildSimulator(scene);
  const std::array<double, 3> lanes{0.8, 2.56, 4.3};
  for (const double time : {0.6, scene.duration}) {
    sand.advanceTo(time);
    const Fields fields = sand.fields();
    std::array<double, 3> fronts{};
    for (std::size_t k = 0; k < lanes.size(); ++k) {
      fronts[k] = profileAlong(sand, fields, lanes[k]).reach(0.5 * sand.grid().spacing);
      std::cout << time << " s, lane " << k << ": front at " << fronts[k] << " m\n";
    }
    EXPECT_GT(fronts[1], fronts[0] + 0.1);
    EXPECT_GT(fronts[2], fronts[1] + 0.1);
  }
  EXPECT_EQ(sand.activeCells(), 0u) << "the sand has come to rest";
  EXPECT_LT(sand.ledger().error(), 1e-6);
}

/// As slices, test/validation compares these flumes with a solution of the equations, whose fronts these are.
TEST(PaperScenes, FlumesSendTheirFrontsAsFarAsTheEquationsDo) {
  const Scene scene = sceneNamed("flumes");
  Simulator sand = buildSimulator(scene);
  sand.advanceTo(scene.duration);
  const Fields fields = sand.fields();
  const std::array<double, 3> lanes{0.87, 0.51, 0.15};
  const std::array<double, 3> fronts{0.526, 0.578, 0.721};  // 5 cm deep, at 0, 10 and 20 degrees [m]
  const double spacing = sand.grid().spacing;
  double runout = 0.4;
  for (std::size_t k = 0; k < lanes.size(); ++k) {
    const Profile profile = profileAlong(sand, fields, lanes[k]);
    EXPECT_NEAR(profile.reach(0.05), fronts[k], 2.0 * spacing) << "flume " << k;
    EXPECT_GT(profile.reach(0.01), runout + 0.1) << "flume " << k;
    runout = profile.reach(0.01);
  }
  EXPECT_EQ(sand.activeCells(), 0u) << "the sand has come to rest";
  EXPECT_LT(sand.ledger().error(), 1e-6);
}

/// The paper's figure 12: mean difference of depths above the base, at the time when it is largest.
TEST(PaperScenes, DamsOnSandOfTwoDepthsDifferLessWhereALayerFlows) {
  Simulator sand = buildSimulator(sceneNamed("raised_dam_breaks"));
  const auto difference = [&](const Fields& fields, double shallow, double deep) {
    const std::vector<double> one = profileAlong(sand, fields, shallow).depth;
    const std::vector<double> other = profileAlong(sand, fields, deep).depth;
    double sum = 0.0;
    for (std::size_t k = 0; k < one.size(); ++k) sum += std::abs((one[k] - 0.3) - (other[k] - 1.0));
    return sum / static_cast<double>(one.size());
  };
  double whole = 0.0;
  double layer = 0.0;
  for (int frame = 1; frame <= 70; ++frame) {
    sand.advanceTo(0.01 * frame);
    const Fields fields = sand.fields();
    whole = std::max(whole, difference(fields, 0.15, 0.51));
    layer = std::max(layer, difference(fields, 0.87, 1.23));
  }
  std::cout << "largest difference where all flows: " << whole << " m, where 0.2 m flow: " << layer << " m\n";
  EXPECT_GT(whole, 0.01);
  EXPECT_LT(layer, 0.5 * whole);
  EXPECT_LT(sand.ledger().error(), 1e-6);
}

Eigen::Vector3d centreOfMass(const Simulator& sand, const Fields& fields) {
  const Grid& grid = sand.grid();
  Eigen::Vector3d sum(0.0, 0.0, 0.0);
  double mass = 0.0;
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      const std::size_t cell = grid.index(i, j);
      const double depth = fields.depth[cell];
      sum += depth * Eigen::Vector3d(grid.x(i), grid.y(j), fields.bed[cell] + 0.5 * depth);
      mass += depth;
    }
  }
  return sum / mass;
}

/// Of the sand. [m²]
double areaFromAbove(const SurfaceMesh& mesh) {
  double area = 0.0;
  for (const SurfaceMesh::Triangle& triangle : mesh.sand) {
    const Eigen::Vector3d corner = mesh.positions[triangle[0]];
    area += 0.5 * (mesh.positions[triangle[1]] - corner).cross(mesh.positions[triangle[2]] - corner).z();
  }
  return area;
}

TEST(PaperScenes, AvalancheLosesByFrictionWhatItFalls) {
  const Scene scene = sceneNamed("avalanche");
  Simulator snow = buildSimulator(scene);
  const Eigen::Vector3d from = centreOfMass(snow, snow.fields());
  snow.advanceTo(scene.duration);
  const Fields fields = snow.fields();
  const Eigen::Vector3d way = centreOfMass(snow, fields) - from;
  // Friction takes tan 20° of the fall on every metre of the way, which is longer than the straight one;
  // walls of the gully and the sand itself take more.
  const double slope = -way.z() / way.head<2>().norm();
  std::cout << "the centre of mass goes " << way.head<2>().norm() << " m and falls " << -way.z()
            << " m: " << std::atan(slope) / kDegree << " degrees\n";
  EXPECT_GT(slope, std::tan(20.0 * kDegree));
  EXPECT_LT(slope, std::tan(30.0 * kDegree));
  EXPECT_GT(way.head<2>().norm(), 700.0);
  EXPECT_LT(snow.ledger().error(), 1e-6);

  // What is shown ends where the snow is a tenth of a cell deep.
  const Grid& grid = snow.grid();
  const double shown = static_cast<double>(std::count_if(
      fields.depth.begin(), fields.depth.end(), [&](float depth) { return depth > 0.1f * grid.spacing; }));
  const double covered = areaFromAbove(surfaceMesh(grid, fields)) / grid.cellArea();
  std::cout << "snow on " << shown << " cells, shown on " << covered << "\n";
  EXPECT_NEAR(covered, shown, 0.05 * shown);
}

}  // namespace
}  // namespace shallow_sand
