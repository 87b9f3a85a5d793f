#include <gtest/gtest.h>

#include <memory>

#include "cuda_calls.h"
#include "parity.h"
#include "shallow_sand/sim/engine.h"

/// A run of steps that takes the GPU more than one launch.
namespace shallow_sand {
namespace {

using CudaLaunches = CudaTest;

EngineStart engineStart(const RandomScene& scene) {
  const SimulatorParameters& parameters = scene.sand.parameters;
  EngineStart start;
  start.grid = parameters.grid.grid();
  start.sand = sandConstants(start.grid, parameters.gravity, parameters.material);
  start.open = {true, false, true, false};
  const std::vector<float> rest(start.grid.cells(), 0.0f);
  start.fields = {scene.sand.bed, scene.sand.depth, rest, rest};
  start.material = localMaterial(parameters.material, scene.sand.material, start.grid);
  start.with_slopes = parameters.solver.reconstruction == Reconstruction::minmod;
  start.displacement = true;
  return start;
}

/// A body that is not turned, where it stands in the frame of cell (0, 0)'s corner, with this velocity along
/// x.
PlacedBody placedBody(std::size_t number, const DistanceField& field, const Eigen::Vector3d& position,
                      double velocity, const Grid& grid) {
  const auto vector = [](const Eigen::Vector3d& v) {
    return Vector3{static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
  };
  const Eigen::Vector3d low = position + field.origin;
  const Eigen::Vector3d high =
      low + field.spacing * Eigen::Vector3d(field.samples[0] - 1, field.samples[1] - 1, field.samples[2] - 1);
  PlacedBody placed;
  placed.body = number;
  placed.view = BodyView{};
  placed.view.field = field.view(nullptr);
  placed.view.axis_x = {1.0f, 0.0f, 0.0f};
  placed.view.axis_y = {0.0f, 1.0f, 0.0f};
  placed.view.axis_z = {0.0f, 0.0f, 1.0f};
  placed.view.position = vector(position);
  placed.view.linear = {static_cast<float>(velocity), 0.0f, 0.0f};
  placed.view.low = vector(low);
  placed.view.high = vector(high);
  placed.window = Window::around(low.x(), low.y(), high.x(), high.y(), grid);
  return placed;
}

/// The first body goes on by a quarter of a cell from one placement to the next, and rests in the last ones;
/// the second one stands.
std::vector<Placement> placementsOf(const RandomScene& scene, int count) {
  const Grid grid = scene.sand.parameters.grid.grid();
  const double spacing = grid.spacing;
  const double between = 3.0 * scene.frame / count;
  const double height = 4.0 * spacing;
  std::vector<Placement> placements;
  for (int k = 0; k < count; ++k) {
    const int moves = std::min(k, count / 2);
    PlacedBody first =
        placedBody(0, *scene.bodies[0].field, {(6.0 + 0.25 * moves) * spacing, 7.0 * spacing, height},
                   k > count / 2 ? 0.0 : 0.25 * spacing / between, grid);
    first.still = k - moves;
    PlacedBody second =
        placedBody(1, *scene.bodies[1].field, {17.0 * spacing, 7.0 * spacing, height}, 0.0, grid);
    second.still = k;
    placements.push_back({between * (k + 1), {first, second}});
  }
  return placements;
}

StepRun runOf(const RandomScene& scene) {
  StepRun run{};
  run.bounds = {scene.sand.parameters.solver.courant * scene.sand.parameters.grid.spacing, 0.1, 0.0};
  run.end = 3.0 * scene.frame;
  run.displacement = true;
  run.most_steps = std::numeric_limits<std::uint64_t>::max();
  run.trial = std::numeric_limits<double>::infinity();
  run.placement = -1;
  return run;
}

/// What an engine comes to.
struct Outcome {
  Fields fields;
  StepRun run;
  double poured;
  double left;
};

Outcome outcomeOf(Engine& engine, const RandomScene& scene) {
  for (const RandomBody& body : scene.bodies) engine.addBody(*body.field);
  for (const Pour& pour : scene.pours) {
    Region region;
    region.center = pour.position;
    region.radius = pour.radius;
    engine.addPour(localRegion(region, scene.sand.parameters.grid.grid()),
                   {pour.start, pour.stop, pour.rate});
  }
  engine.start(runOf(scene), scene.bodies.empty() ? std::vector<Placement>() : placementsOf(scene, 20));
  const StepRun run = engine.finish();
  engine.requestFields();
  return {engine.collectFields(), run, engine.poured(), engine.left()};
}

void expectSame(const Outcome& one, const Outcome& other) {
  expectSameBits(one.fields, other.fields);
  EXPECT_EQ(one.run.time, other.run.time);
  EXPECT_EQ(one.run.trial, other.run.trial);
  EXPECT_EQ(one.run.placement, other.run.placement);
  EXPECT_EQ(one.run.steps_since_placed, other.run.steps_since_placed);
  EXPECT_EQ(one.run.progress.steps, other.run.progress.steps);
  EXPECT_EQ(one.run.progress.last_step, other.run.progress.last_step);
  EXPECT_EQ(one.run.progress.repeated_steps, other.run.progress.repeated_steps);
  EXPECT_EQ(one.poured, other.poured);
  EXPECT_EQ(one.left, other.left);
}

/// The same run on the CPU, and on the GPU in launches of a few steps.
void compareLaunches(int bodies) {
  std::mt19937 random = seededGenerator();
  const RandomScene scene = tiltedScene(random, {24, 14}, 2, bodies);
  const EngineStart start = engineStart(scene);
  const auto cpu = makeHostEngine(start, 1, true, instructionSets().back());
  const Outcome expected = outcomeOf(*cpu, scene);
  EXPECT_EQ(expected.run.time, 3.0 * scene.frame);
  for (const std::uint64_t steps_at_once : {1, 3, 1000}) {
    SCOPED_TRACE(std::to_string(steps_at_once) + " steps at once");
    const auto cuda = makeCudaEngine(start, steps_at_once);
    const std::size_t before = launches();
    expectSame(expected, outcomeOf(*cuda, scene));
    const std::uint64_t steps = expected.run.progress.steps;
    // One more gathers the fields.
    EXPECT_EQ(launches() - before, (steps + steps_at_once - 1) / steps_at_once + 1);
  }
}

TEST_F(CudaLaunches, SandGoesOn) { compareLaunches(0); }

TEST_F(CudaLaunches, SandAmongBodiesGoesOn) { compareLaunches(2); }

}  // namespace
}  // namespace shallow_sand
