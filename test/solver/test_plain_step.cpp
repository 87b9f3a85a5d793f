#include <gtest/gtest.h>

#include <cstdio>

#include "random_scene.h"
#include "random_seed.h"
#include "shallow_sand/bodies/motion.h"
#include "shallow_sand/coupling/rays_alone.h"
#include "shallow_sand/device/host_executor.h"
#include "shallow_sand/sim/engine_on.h"
#include "shallow_sand/solver/grid_stepper.h"

namespace shallow_sand {
namespace {

/// Every cell, one after the other, each computing all that it needs: what the equations say, and what a GPU
/// does.
using PlainEngine = EngineOn<HostExecutor, RaysAlone, GridStepper<HostExecutor>>;

EngineStart startOf(const RandomScene& scene) {
  const SimulatorParameters& parameters = scene.sand.parameters;
  const auto open = [](Edge edge) { return edge == Edge::open; };
  const Edges& edges = parameters.edges;
  EngineStart start;
  start.grid = parameters.grid.grid();
  start.sand = sandConstants(start.grid, parameters.gravity, parameters.material);
  start.open = {open(edges.x_min), open(edges.x_max), open(edges.y_min), open(edges.y_max)};
  const std::vector<float> rest(start.grid.cells(), 0.0f);
  start.fields = {scene.sand.bed, scene.sand.depth, rest, rest};
  start.material = localMaterial(parameters.material, scene.sand.material, start.grid);
  start.with_slopes = parameters.solver.reconstruction == Reconstruction::minmod;
  return start;
}

Vector3 rounded(const Eigen::Vector3d& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

/// A body where it is at a time; its window is that of a ball around it.
PlacedBody placed(const RandomScene& scene, std::size_t number, double time) {
  const Grid grid = scene.sand.parameters.grid.grid();
  const RandomBody& body = scene.bodies[number];
  Motion motion;
  for (const PoseKey& key : body.motion) motion.append(key.time, key.pose);
  const Eigen::Isometry3d pose =
      Eigen::Translation3d(-grid.origin_x, -grid.origin_y, 0.0) * motion.poseAt(time);
  const Twist twist = motion.twistAt(time);
  const Eigen::Vector3d middle = pose.translation();
  const Eigen::Vector3d reach = Eigen::Vector3d::Constant(body.radius + 2.0 * body.field->spacing);
  const Eigen::Matrix3d to_body = pose.linear().transpose();
  const auto cell = [&](double position, int count) {
    return static_cast<int>(std::clamp(std::floor(position / grid.spacing), 0.0, 1.0 * count));
  };
  PlacedBody result;
  result.body = number;
  result.view = {static_cast<int>(number), body.field->view(nullptr), rounded(to_body.col(0)),
                 rounded(to_body.col(1)),  rounded(to_body.col(2)),   rounded(middle),
                 rounded(twist.linear),    rounded(twist.angular),    rounded(middle - reach),
                 rounded(middle + reach)};
  result.window = {cell(middle.x() - reach.x(), grid.columns), cell(middle.y() - reach.y(), grid.rows),
                   cell(middle.x() + reach.x() + grid.spacing, grid.columns),
                   cell(middle.y() + reach.y() + grid.spacing, grid.rows)};
  return result;
}

std::vector<PlacedBody> allPlaced(const RandomScene& scene, double time) {
  std::vector<PlacedBody> bodies;
  for (std::size_t number = 0; number < scene.bodies.size(); ++number) {
    const PlacedBody body = placed(scene, number, time);
    if (!body.window.empty()) bodies.push_back(body);
  }
  return bodies;
}

void addAll(const RandomScene& scene, SteppedEngine& engine) {
  const Grid grid = scene.sand.parameters.grid.grid();
  for (const RandomBody& body : scene.bodies) engine.addBody(*body.field);
  for (const Pour& pour : scene.pours) {
    Region region;
    region.center = pour.position;
    region.radius = pour.radius;
    engine.addPour(localRegion(region, grid), {});
  }
}

void expectSame(SteppedEngine& plain, SteppedEngine& tiled) {
  expectSameBits(plain.fields(), tiled.fields());
  ASSERT_FALSE(::testing::Test::HasFailure());
  ASSERT_EQ(plain.left(), tiled.left());
  ASSERT_EQ(plain.poured(), tiled.poured());
}

/// Runs both side by side; some steps are attempted twice, as after a bound that was broken.
void compare(std::mt19937& random, const RandomScene& scene, int steps) {
  const EngineStart start = startOf(scene);
  PlainEngine plain(HostExecutor(1), RaysAlone{}, start, start.with_slopes);
  const std::unique_ptr<SteppedEngine> tiled = makeHostEngine(start, 1, true, instructionSets().back());
  double time = 0.0;
  const std::initializer_list<SteppedEngine*> engines{&plain, tiled.get()};
  for (SteppedEngine* engine : engines) {
    addAll(scene, *engine);
    engine->placeBodies(allPlaced(scene, time), 1);
  }
  float dt = static_cast<float>(0.05 * scene.frame);
  for (int step = 0; step < steps; ++step) {
    const float speed = plain.attempt(dt);
    ASSERT_EQ(speed, tiled->attempt(dt));
    const double bound = scene.sand.parameters.solver.courant * start.grid.spacing /
                         std::max(static_cast<double>(speed), 1e-9);
    if (dt > bound || random() % 8 == 0) {
      dt = static_cast<float>(std::min(uniform(random, 0.3, 1.0) * bound, scene.frame));
      ASSERT_EQ(plain.attempt(dt), tiled->attempt(dt));
    }
    time += dt;
    const int hops = 1 + static_cast<int>(random() % 3);
    for (SteppedEngine* engine : engines) {
      engine->accept();
      for (std::size_t k = 0; k < scene.pours.size(); ++k)
        if (step % 7 != 0) engine->pour(k, dt * scene.pours[k].rate);
      engine->placeBodies(allPlaced(scene, time), hops);
    }
    ASSERT_NO_FATAL_FAILURE(expectSame(plain, *tiled)) << "step " << step;
    dt = static_cast<float>(std::min(uniform(random, 0.3, 1.0) * bound, scene.frame));
  }
}

Size randomSize(std::mt19937& random, int scene) {
  const auto count = [&](int least, int most) { return randomCount(random, least, most); };
  switch (scene % 4) {
    case 0:
      return {count(1, 6), count(1, 6)};
    case 1:
      return {count(20, 80), count(20, 80)};
    case 2:
      return random() % 2 == 0 ? Size{count(1, 4), count(60, 300)} : Size{count(60, 300), count(1, 4)};
    default:
      return {count(260, 400), count(10, 40)};
  }
}

TEST(PlainStep, CellByCellGivesTheSameBitsAsRowsOfTilesThatSleep) {
  std::mt19937 random = seededGenerator();
  for (int number = 0; number < 60; ++number) {
    const Size size = randomSize(random, number);
    SCOPED_TRACE("scene " + std::to_string(number) + ": " + std::to_string(size.columns) + " x " +
                 std::to_string(size.rows));
    RandomSand sand = random() % 2 == 0
                          ? randomSand(random, size.columns, size.rows)
                          : heldSand(random, size.columns, size.rows, uniform(random, 0.0, 10.0));
    if (random() % 2 == 0) sand.parameters.gravity = randomGravity(random, 3.0);
    const RandomScene scene =
        randomScene(random, std::move(sand), static_cast<int>(random() % 2), static_cast<int>(random() % 2));
    ASSERT_NO_FATAL_FAILURE(compare(random, scene, 60));
  }
}

/// Grids lower and narrower than a tile, and sand that moves in one row or column only.
TEST(PlainStep, SpeedsOfThinGridsAreSeen) {
  std::mt19937 random = seededGenerator();
  for (int thickness = 1; thickness <= 18; ++thickness) {
    for (const bool lies : {true, false}) {
      for (int moved = 0; moved < thickness; ++moved) {
        SCOPED_TRACE((lies ? "row " : "column ") + std::to_string(moved) + " of " +
                     std::to_string(thickness));
        RandomSand sand = randomSand(random, lies ? 40 : thickness, lies ? thickness : 40);
        const Grid grid = sand.parameters.grid.grid();
        sand.bed.assign(grid.cells(), 0.0f);
        sand.depth.assign(grid.cells(), 0.0f);
        for (int along = 0; along < 7; ++along)
          sand.depth[lies ? grid.index(along, moved) : grid.index(moved, along)] = 10.0f * grid.spacing;
        ASSERT_NO_FATAL_FAILURE(compare(random, randomScene(random, sand, 0, 0), 6));
      }
    }
  }
}

}  // namespace
}  // namespace shallow_sand
