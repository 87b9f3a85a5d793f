#include <gtest/gtest.h>

#include "random_seed.h"
#include "requested_fields.h"

namespace shallow_sand {
namespace {

TEST(RequestedFields, AreThoseThatThereAreAndTheirChangesAreTold) {
  std::mt19937 random = seededGenerator();
  followRandomRuns(random, 20, {150, 90}, Backend::cpu);
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
