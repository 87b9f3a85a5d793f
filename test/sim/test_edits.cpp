#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "random_edit.h"
#include "random_fields.h"
#include "random_scene.h"
#include "random_seed.h"
#include "same_run.h"

namespace shallow_sand {
namespace {

bool holds(const Region& region, double x, double y) {
  const double dx = x - region.center.x();
  const double dy = y - region.center.y();
  if (region.shape == Region::Shape::disc) return std::hypot(dx, dy) <= region.radius;
  return std::abs(dx) <= 0.5 * region.size.x() && std::abs(dy) <= 0.5 * region.size.y();
}

TEST(Edits, LedgerFollowsEditsOfMovingSand) {
  std::mt19937 random = seededGenerator();
  for (int scene = 0; scene < 30; ++scene) {
    RandomSand sand = randomSand(random, 5 + random() % 70, 5 + random() % 40);
    sand.parameters.edges = randomEdges(random);
    Simulator simulator(sand.parameters, sand.bed, sand.depth);
    for (int frame = 0; frame < 8; ++frame) {
      simulator.advance(0.02);
      const double before = simulator.ledger().now;
      const double grown = simulator.edit(randomEdit(random, simulator.grid()));
      EXPECT_NEAR(simulator.ledger().now - before, grown, 1e-9 * (1.0 + std::abs(grown)));
      for (const float depth : simulator.fields().depth) ASSERT_GE(depth, 0.0f);
    }
    EXPECT_LT(simulator.ledger().error(), 1e-6) << "scene " << scene;
  }
}

TEST(Edits, DoWhatTheySay) {
  std::mt19937 random = seededGenerator();
  for (int scene = 0; scene < 40; ++scene) {
    const RandomSand sand = randomSand(random, 40, 30);
    Simulator simulator(sand.parameters, sand.bed, sand.depth);
    const Grid& grid = simulator.grid();
    Edit edit = randomEdit(random, grid);
    // Large enough that no cell of it is but the nearest one.
    edit.region.radius += grid.spacing;
    edit.region.size.array() += 2.0 * grid.spacing;
    simulator.edit(edit);
    const Fields fields = simulator.fields();
    const float value = static_cast<float>(edit.value);
    for (int j = 0; j < grid.rows; ++j) {
      for (int i = 0; i < grid.columns; ++i) {
        const std::size_t k = grid.index(i, j);
        const bool inner = holds(edit.region, grid.x(i), grid.y(j));
        if (fields.depth[k] == sand.depth[k]) continue;
        ASSERT_TRUE(inner || std::abs(std::hypot(grid.x(i) - edit.region.center.x(),
                                                 grid.y(j) - edit.region.center.y()) -
                                      edit.region.radius) < 1e-4 * grid.spacing)
            << "a cell outside of the region has changed";
        float expected = 0.0f;
        if (edit.operation == EditOperation::add) expected = sand.depth[k] + value;
        if (edit.operation == EditOperation::remove) expected = std::max(sand.depth[k] - value, 0.0f);
        if (edit.operation == EditOperation::set) expected = value;
        if (edit.operation == EditOperation::level) expected = std::max(value - sand.bed[k], 0.0f);
        ASSERT_EQ(fields.depth[k], expected);
      }
    }
  }
}

EditOperation randomSetting(std::mt19937& random) {
  return random() % 2 == 0 ? EditOperation::set : EditOperation::level;
}

TEST(Edits, CellsAreSetAsTold) {
  std::mt19937 random = seededGenerator();
  for (int scene = 0; scene < 40; ++scene) {
    const RandomSand sand = randomSand(random, 1 + random() % 60, 1 + random() % 40);
    Simulator simulator(sand.parameters, sand.bed, sand.depth);
    const EditOperation operation = randomSetting(random);
    const CellValues cells = randomCellValues(random, simulator.grid(), operation);
    const double before = simulator.ledger().now;
    const double grown = simulator.setSand(operation, cells);
    const Fields fields = simulator.fields();
    for (std::size_t k = 0; k < fields.depth.size(); ++k) {
      float expected = sand.depth[k];
      if (cells.given[k] != 0)
        expected =
            operation == EditOperation::set ? cells.values[k] : std::max(cells.values[k] - sand.bed[k], 0.0f);
      ASSERT_EQ(fields.depth[k], expected);
    }
    const Ledger ledger = simulator.ledger();
    EXPECT_NEAR(ledger.now - before, grown, 1e-9 * (1.0 + std::abs(grown)));
    EXPECT_NEAR(ledger.poured - ledger.left, grown, 1e-9 * (1.0 + ledger.poured + ledger.left));
    simulator.advance(0.02);
    EXPECT_LT(simulator.ledger().error(), 1e-6);
  }
}

/// Of sand that moves, too, and among bodies.
TEST(Edits, OneValueForAllCellsIsAnEditOfTheWholeMap) {
  std::mt19937 random = seededGenerator();
  for (int number = 0; number < 20; ++number) {
    const RandomScene scene = randomScene(random, randomSand(random, 30, 20), 1, 2);
    Simulator one = simulatorOf(scene, scene.sand.parameters);
    Simulator other = simulatorOf(scene, scene.sand.parameters);
    advanceFrames(one, scene.frame, 0, 4);
    advanceFrames(other, scene.frame, 0, 4);
    const Grid& grid = one.grid();
    Edit edit;
    edit.operation = randomSetting(random);
    edit.value = uniform(random, 0.0, 5.0) * grid.spacing;
    edit.region.shape = Region::Shape::rectangle;
    edit.region.size = 3.0 * scene.sand.parameters.grid.size;
    edit.region.center = scene.sand.parameters.grid.origin;
    const CellValues all{std::vector<float>(grid.cells(), static_cast<float>(edit.value)),
                         std::vector<std::uint8_t>(grid.cells(), 1)};
    EXPECT_EQ(one.edit(edit), other.setSand(edit.operation, all));
    expectSameRun(one, other);
    advanceFrames(one, scene.frame, 4, 8);
    advanceFrames(other, scene.frame, 4, 8);
    expectSameRun(one, other);
  }
}

TEST(Edits, CellsThatMakeNoSenseAreRefusedAndChangeNothing) {
  std::mt19937 random = seededGenerator();
  const RandomSand sand = randomSand(random, 20, 10);
  Simulator simulator(sand.parameters, sand.bed, sand.depth);
  const CellValues good{std::vector<float>(200, 0.1f), std::vector<std::uint8_t>(200, 1)};
  const auto refused = [&](EditOperation operation, const std::function<void(CellValues&)>& spoil) {
    CellValues cells = good;
    spoil(cells);
    EXPECT_THROW(simulator.setSand(operation, cells), InvalidParameter);
    EXPECT_TRUE(sameBits(simulator.fields().depth, sand.depth));
  };
  const std::size_t k = random() % 200;
  for (const EditOperation operation : {EditOperation::set, EditOperation::level}) {
    refused(operation, [&](CellValues& cells) { cells.values[k] = std::nanf(""); });
    refused(operation, [&](CellValues& cells) { cells.values[k] = INFINITY; });
    refused(operation, [](CellValues& cells) { cells.values.pop_back(); });
    refused(operation, [](CellValues& cells) { cells.given.push_back(1); });
  }
  refused(EditOperation::set, [&](CellValues& cells) { cells.values[k] = -1e-6f; });
  refused(EditOperation::add, [](CellValues&) {});
  refused(EditOperation::remove, [](CellValues&) {});
  EXPECT_NO_THROW(simulator.setSand(EditOperation::set, good));
}

TEST(Edits, SandThatStaysKeepsItsVelocity) {
  std::mt19937 random = seededGenerator();
  RandomSand sand = randomSand(random, 40, 40);
  sand.parameters.gravity = {3.0, 2.0, -9.81};
  sand.parameters.material.friction_angle = 0.1;
  std::fill(sand.bed.begin(), sand.bed.end(), 0.0f);
  std::fill(sand.depth.begin(), sand.depth.end(), static_cast<float>(10.0 * sand.parameters.grid.spacing));
  Simulator simulator(sand.parameters, sand.bed, sand.depth);
  simulator.advance(0.2);
  const Fields before = simulator.fields();
  Edit edit;
  edit.region.center = sand.parameters.grid.origin + 0.5 * sand.parameters.grid.size;
  edit.region.radius = 5.0 * sand.parameters.grid.spacing;
  edit.operation = EditOperation::remove;
  edit.value = 3.0 * sand.parameters.grid.spacing;
  EXPECT_LT(simulator.edit(edit), 0.0);
  const Fields after = simulator.fields();
  for (std::size_t k = 0; k < before.depth.size(); ++k) {
    const float velocity = before.momentum_x[k] / before.depth[k];
    ASSERT_NEAR(after.momentum_x[k] / after.depth[k], velocity, 1e-6 * (1.0 + std::abs(velocity)));
  }
}

TEST(Edits, PoursThatTakeAwayStopAtTheBed) {
  std::mt19937 random = seededGenerator();
  RandomSand sand = randomSand(random, 50, 50);
  std::fill(sand.bed.begin(), sand.bed.end(), 0.0f);
  const double spacing = sand.parameters.grid.spacing;
  std::fill(sand.depth.begin(), sand.depth.end(), static_cast<float>(3.0 * spacing));
  Simulator simulator(sand.parameters, sand.bed, sand.depth);
  Pour pump;
  pump.position = sand.parameters.grid.origin + 0.5 * sand.parameters.grid.size;
  pump.radius = 6.0 * spacing;
  const double disc = M_PI * pump.radius * pump.radius * 3.0 * spacing;
  pump.rate = -20.0 * disc;
  pump.stop = 0.2;
  simulator.addPour(pump);
  simulator.advance(0.3);
  const Ledger ledger = simulator.ledger();
  EXPECT_GT(ledger.left, 0.9 * disc);
  EXPECT_LT(ledger.left, 4.0 * disc) << "it would be this if the pump took what is not there";
  EXPECT_EQ(ledger.poured, 0.0);
  EXPECT_LT(ledger.error(), 1e-6);
  for (const float depth : simulator.fields().depth) ASSERT_GE(depth, 0.0f);
}

TEST(Edits, WakeSandThatSleeps) {
  SimulatorParameters parameters;
  parameters.backend = Backend::cpu;
  parameters.grid.size = {4.0, 4.0};
  const std::size_t cells = parameters.grid.grid().cells();
  Simulator simulator(parameters, std::vector<float>(cells, 0.0f), std::vector<float>(cells, 0.2f));
  simulator.advance(0.5);
  EXPECT_EQ(simulator.activeCells(), 0u);
  Edit edit;
  edit.region.center = {2.0, 2.0};
  edit.region.radius = 0.2;
  edit.operation = EditOperation::level;
  edit.value = 0.6;
  simulator.edit(edit);
  simulator.advance(0.1);
  EXPECT_GT(simulator.activeCells(), 0u);
}

TEST(Edits, OfSingleCellsWakeSandThatSleeps) {
  std::mt19937 random = seededGenerator();
  SimulatorParameters parameters;
  parameters.backend = Backend::cpu;
  parameters.grid.size = {4.0, 4.0};
  const std::size_t cells = parameters.grid.grid().cells();
  Simulator simulator(parameters, std::vector<float>(cells, 0.0f), std::vector<float>(cells, 0.2f));
  simulator.advance(0.5);
  ASSERT_EQ(simulator.activeCells(), 0u);
  CellValues column{std::vector<float>(cells, 0.6f), std::vector<std::uint8_t>(cells, 0)};
  column.given[random() % cells] = 1;
  EXPECT_GT(simulator.setSand(EditOperation::set, column), 0.0);
  simulator.advance(0.02);
  EXPECT_GT(simulator.activeCells(), 0u);
}

TEST(Edits, AreRefusedWithTheirKey) {
  SimulatorParameters parameters;
  parameters.backend = Backend::cpu;
  const std::size_t cells = parameters.grid.grid().cells();
  Simulator simulator(parameters, std::vector<float>(cells, 0.0f), std::vector<float>(cells, 0.2f));
  const auto refusal = [&](const Edit& edit) -> std::string {
    try {
      simulator.edit(edit);
    } catch (const InvalidParameter& problem) {
      return problem.what();
    }
    return "";
  };
  Edit edit;
  edit.region.center = {1.0, 1.0};
  edit.value = -1.0;
  EXPECT_EQ(refusal(edit).rfind("value: -1", 0), 0u) << refusal(edit);
  edit.value = 0.1;
  edit.region.radius = 0.0;
  EXPECT_EQ(refusal(edit).rfind("radius: 0", 0), 0u) << refusal(edit);
  edit.region.radius = 0.1;
  edit.region.center = {100.0, 1.0};
  EXPECT_EQ(refusal(edit).rfind("center: [100, 1]", 0), 0u) << refusal(edit);
  EXPECT_EQ(simulator.ledger().error(), 0.0);
}

}  // namespace
}  // namespace shallow_sand
