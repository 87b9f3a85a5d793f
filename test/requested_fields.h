#pragma once

#include <gtest/gtest.h>

#include <vector>

#include "random_edit.h"
#include "random_material.h"
#include "random_scene.h"

namespace shallow_sand {

/// What a copy has to take over from the fields to be the same again, by the windows that are said to hold
/// all changes.
inline void takeOver(const Fields& fields, const std::vector<Window>& windows, const Grid& grid,
                     Fields& copy) {
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
inline void disturb(std::mt19937& random, const RandomScene& scene, Simulator& simulator,
                    std::vector<std::size_t>& bodies, std::vector<Snapshot>& kept) {
  const double spacing = scene.sand.parameters.grid.spacing;
  switch (random() % 10) {
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
    case 7:
      simulator.setMaterial(otherMaterial(random, simulator, scene.sand.material));
      return;
    case 8:
      simulator.setGravity(otherGravity(random));
      return;
    default:
      return;
  }
}

/// Asks for fields now and then, and compares them with those that are there.
inline void followRandomRun(std::mt19937& random, RandomScene scene, Backend backend) {
  scene.sand.parameters.backend = backend;
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
    // The sand may go on meanwhile.
    if (random() % 2 == 0) simulator.beginAdvanceTo(simulator.time() + scene.frame);
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

/// Random runs of sand on grids up to a size; in every other one most of it sleeps.
inline void followRandomRuns(std::mt19937& random, int runs, const Size& largest, Backend backend) {
  for (int run = 0; run < runs; ++run) {
    SCOPED_TRACE(run);
    const int columns = randomCount(random, 5, largest.columns);
    const int rows = randomCount(random, 5, largest.rows);
    RandomSand sand = random() % 2 == 0 ? heldSand(random, columns, rows) : randomSand(random, columns, rows);
    sand.parameters.coupling = random() % 4 != 0 ? Coupling::displacement : Coupling::drag;
    const int pours = randomCount(random, 0, 2);
    followRandomRun(random, randomScene(random, sand, pours, randomCount(random, 0, 2)), backend);
    if (::testing::Test::HasFatalFailure()) return;
  }
}

}  // namespace shallow_sand
