#include <gtest/gtest.h>

#include <numeric>

#include "random_fields.h"
#include "random_scene.h"
#include "random_seed.h"
#include "shallow_sand/core/moved_volume.h"

namespace shallow_sand {
namespace {

TEST(MovedVolume, IsNoneWhereNothingHasMoved) {
  std::mt19937 random = seededGenerator();
  const RandomSand sand = heldSand(random, 31, 45);
  Simulator simulator(sand.parameters, sand.bed, sand.depth);
  simulator.advance(0.1);
  const MovedVolume moved = movedVolume(simulator.grid(), sand.depth, simulator.fields());
  EXPECT_EQ(moved.dug, 0.0);
  EXPECT_EQ(moved.heaped, 0.0);
}

/// A pit and a heap that do not overlap, by the volumes that the ledger knows.
TEST(MovedVolume, IsThatOfPitsAndHeaps) {
  std::mt19937 random = seededGenerator();
  for (int trial = 0; trial < 10; ++trial) {
    const RandomSand sand = randomSand(random, 60, 40);
    Simulator simulator(sand.parameters, sand.bed, sand.depth);
    const Eigen::Vector2d corner = sand.parameters.grid.origin;
    const double spacing = sand.parameters.grid.spacing;
    Edit edit;
    edit.region.radius = uniform(random, 1.0, 12.0) * spacing;
    edit.value = uniform(random, 0.1, 10.0) * spacing;
    edit.region.center = corner + spacing * Eigen::Vector2d(15.0, 20.0);
    const double heap = simulator.edit(edit);
    edit.operation = EditOperation::remove;
    edit.region.center = corner + spacing * Eigen::Vector2d(45.0, 20.0);
    const double pit = -simulator.edit(edit);
    const MovedVolume moved = movedVolume(simulator.grid(), sand.depth, simulator.fields());
    EXPECT_NEAR(moved.heaped, heap, 1e-5 * heap);
    EXPECT_NEAR(moved.dug, pit, 1e-5 * pit);
    EXPECT_GT(heap, 0.0);
  }
}

/// Whatever happens: what is heaped, less what is dug, is by how much there is more.
TEST(MovedVolume, AgreesWithTheLedger) {
  std::mt19937 random = seededGenerator();
  for (int trial = 0; trial < 12; ++trial) {
    const RandomScene scene = randomScene(random, randomSand(random, 41, 33), 2, 3);
    Simulator simulator = simulatorOf(scene, scene.sand.parameters);
    for (int frame = 0; frame < 4; ++frame) {
      simulator.advance(2.0 * scene.frame);
      const Ledger ledger = simulator.ledger();
      const MovedVolume moved = movedVolume(simulator.grid(), scene.sand.depth, simulator.fields());
      EXPECT_NEAR(moved.heaped - moved.dug, ledger.now - ledger.start, 1e-9 * ledger.start);
      EXPECT_GT(moved.dug, 0.0);
      EXPECT_GT(moved.heaped, 0.0);
    }
  }
}

/// Sand that lies on a buried plate is where it was; what lies on one in the air is above the first surface.
TEST(MovedVolume, OfAPlateIsItsOwnWhereItIsBuriedAndWhatItCarriesInTheAir) {
  std::mt19937 random = seededGenerator();
  for (const bool in_air : {false, true}) {
    constexpr double kSpacing = 0.02;
    const double depth = uniform(random, 0.3, 0.5);
    const Eigen::Vector3d size(0.4, 0.32, 0.06);
    SimulatorParameters parameters;
    parameters.grid.size = {1.0, 1.0};
    parameters.grid.spacing = kSpacing;
    parameters.backend = Backend::cpu;
    parameters.threads = 1;
    const std::vector<float> start(parameters.grid.grid().cells(), static_cast<float>(depth));
    Simulator simulator(parameters, std::vector<float>(start.size(), 0.0f), start);
    const TriangleMesh mesh = triangulate(Box{size});
    const std::size_t plate = simulator.addBody(
        "plate",
        std::make_shared<const DistanceField>(computeDistanceField(mesh, distanceSpacing(mesh, kSpacing))));
    const double above = in_air ? uniform(random, 0.1, 0.3) : -uniform(random, 0.1, 0.15);
    simulator.placeBody(plate, poseOf({0.5, 0.5}, depth + above, Eigen::Quaterniond::Identity()));
    simulator.advance(0.0);
    double expected = size.prod();
    if (in_air) {
      Edit shower;
      shower.region.center = {0.5, 0.5};
      shower.value = uniform(random, 0.01, 0.1);
      expected = simulator.edit(shower);
    }
    const MovedVolume moved = movedVolume(simulator.grid(), start, simulator.fields());
    EXPECT_NEAR(moved.dug, in_air ? 0.0 : expected, 0.01 * expected);
    EXPECT_NEAR(moved.heaped, expected, 0.01 * expected);
  }
}

TEST(MovedVolume, RefusesAnotherNumberOfCells) {
  Fields fields;
  fields.depth.assign(12, 1.0f);
  EXPECT_THROW(movedVolume(Grid{4, 3, 0.1f}, std::vector<float>(11, 1.0f), fields), InvalidParameter);
}

}  // namespace
}  // namespace shallow_sand
