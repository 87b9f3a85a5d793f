#include <gtest/gtest.h>

#include "random_edit.h"
#include "random_scene.h"
#include "random_seed.h"

namespace shallow_sand {
namespace {

/// What a copy has to take over from the fields to be the same again, by the windows that are said to hold
/// all changes.
void takeOver(const Fields& fields, const std::vector<Window>& windows, const Grid& grid, Fields& copy) {
  if (copy.load.empty() && !fields.load.empty()) copy.addLoads();
  for (const auto member :
       {&Fields::bed, &Fields::depth, &Fields::momentum_x, &Fields::momentum_y, &Fields::load,
        &Fields::load_elevation, &Fields::load_momentum_x, &Fields::load_momentum_y}) {
    if ((fields.*member).empty()) continue;
    for (const Window& window : windows) {
      for (int j = window.row_begin; j < window.row_end; ++j) {
        for (int i = window.column_begin; i < window.column_end; ++i)
          (copy.*member)[grid.index(i, j)] = (fields.*member)[grid.index(i, j)];
      }
    }
  }
}

/// Something that changes the sand, or may, between two frames.
void disturb(std::mt19937& random, const RandomScene& scene, Simulator& simulator,
             std::vector<std::size_t>& bodies, std::vector<Snapshot>& kept) {
  const double spacing = scene.sand.parameters.grid.spacing;
  switch (random() % 8) {
    case 0:
    case 1:
      simulator.edit(randomEdit(random, simulator.grid()));
      return;
    case 2: {
      const RandomBody body = randomBody(random, spacing);
      bodies.push_back(simulator.addBody("new", body.field));
      const Eigen::Vector2d place = randomPlace(random, simulator.grid(), 0.0);
      simulator.placeBody(bodies.back(), poseOf(place, randomHeight(random, scene.sand, place, body.radius),
                                                randomRotation(random)));
      return;
    }
    case 3:
      if (bodies.empty()) return;
      simulator.removeBody(bodies.back());
      bodies.pop_back();
      return;
    case 4: {
      Pour pour = randomPour(random, scene);
      pour.start += simulator.time();
      pour.stop += simulator.time();
      simulator.addPour(pour);
      return;
    }
    case 5:
      kept.assign(1, simulator.snapshot());
      return;
    case 6:
      // Bodies may have come since.
      if (kept.empty() || (kept[0].fields.load.empty() != simulator.fields().load.empty())) return;
      simulator.restore(kept[0]);
      return;
    default:
      return;
  }
}

/// Asks for fields now and then, and compares them with those that are there.
void followRandomRun(std::mt19937& random, RandomScene scene) {
  scene.sand.parameters.threads = randomCount(random, 1, 2);
  Simulator simulator = simulatorOf(scene, scene.sand.parameters);
  std::vector<std::size_t> bodies;
  std::vector<Snapshot> kept;
  Fields copy;
  for (int frame = 0; frame < 12; ++frame) {
    const int disturbances = randomCount(random, 0, 2);
    for (int k = 0; k < disturbances; ++k) disturb(random, scene, simulator, bodies, kept);
    if (random() % 4 != 0) simulator.advanceTo(simulator.time() + scene.frame);
    if (random() % 3 == 0) continue;
    const Fields truth = simulator.fields();
    simulator.requestFields();
    const Fields& fields = simulator.collectFields();
    expectSameBits(fields, truth);
    if (random() % 4 == 0) continue;
    const std::vector<Window> changes = simulator.takeChanges();
    if (copy.depth.empty()) {
      ASSERT_EQ(changes, std::vector<Window>{Window::all(simulator.grid())});
      copy = fields;
    }
    takeOver(fields, changes, simulator.grid(), copy);
    expectSameBits(copy, truth);
    if (::testing::Test::HasFailure()) FAIL() << "frame " << frame;
  }
}

TEST(RequestedFields, AreThoseThatThereAreAndTheirChangesAreTold) {
  std::mt19937 random = seededGenerator();
  for (int run = 0; run < 20; ++run) {
    SCOPED_TRACE(run);
    // Held sand sleeps in most of its tiles.
    RandomSand sand = random() % 2 == 0
                          ? heldSand(random, randomCount(random, 20, 150), randomCount(random, 9, 90))
                          : randomSand(random, randomCount(random, 5, 90), randomCount(random, 5, 60));
    sand.parameters.displacement = random() % 4 != 0;
    followRandomRun(random, randomScene(random, sand, randomCount(random, 0, 2), randomCount(random, 0, 2)));
    if (HasFatalFailure()) return;
  }
}

TEST(RequestedFields, OfSandAtRestDoNotChange) {
  std::mt19937 random = seededGenerator();
  const RandomSand sand = heldSand(random, 300, 200);
  Simulator simulator(sand.parameters, sand.bed, sand.depth);
  simulator.advance(0.1);
  simulator.requestFields();
  simulator.takeChanges();
  simulator.advance(0.1);
  simulator.requestFields();
  EXPECT_TRUE(simulator.takeChanges().empty());
  // An edit of one place is told as tiles around it, not as the map.
  Edit edit;
  edit.region.center = randomPlace(random, simulator.grid(), 0.0);
  edit.region.radius = simulator.grid().spacing;
  edit.value = 0.1 * simulator.grid().spacing;
  simulator.edit(edit);
  simulator.requestFields();
  std::size_t cells = 0;
  for (const Window& window : simulator.takeChanges()) cells += window.cells();
  EXPECT_GT(cells, 0u);
  EXPECT_LE(cells, 4u * 32u * 8u);
}

}  // namespace
}  // namespace shallow_sand
