#include <gtest/gtest.h>

#include <string>

#include "parity.h"
#include "random_edit.h"

namespace shallow_sand {
namespace {

using CudaEdits = CudaTest;

/// Edits after every frame, two at once now and then.
void compareEdits(std::mt19937& random, const RandomScene& scene) {
  Pair pair(scene);
  for (int frame = 0; frame < 6 && !::testing::Test::HasFailure(); ++frame) {
    for (int count = randomCount(random, 1, 2); count > 0; --count) {
      const Edit edit = randomEdit(random, pair.cpu.grid());
      SCOPED_TRACE("edit " + std::to_string(static_cast<int>(edit.operation)) + " before frame " +
                   std::to_string(frame));
      EXPECT_EQ(pair.cpu.edit(edit), pair.cuda.edit(edit));
      expectSame(pair.cpu, pair.cuda);
    }
    if (random() % 3 == 0) {
      SCOPED_TRACE("cells set before frame " + std::to_string(frame));
      const EditOperation operation = random() % 2 == 0 ? EditOperation::set : EditOperation::level;
      const CellValues cells = randomCellValues(random, pair.cpu.grid(), operation);
      EXPECT_EQ(pair.cpu.setSand(operation, cells), pair.cuda.setSand(operation, cells));
      expectSame(pair.cpu, pair.cuda);
    }
    pair.advance(scene.frame, 1);
  }
}

/// Scenes of a few sizes that `change` has changed.
template <class Change>
void compareScenes(int pours, int bodies, const Change& change) {
  std::mt19937 random = seededGenerator();
  for (const Size& size : {Size{1, 1}, Size{33, 5}, Size{20, 12}}) {
    SCOPED_TRACE(std::to_string(size.columns) + " x " + std::to_string(size.rows));
    RandomScene scene = tiltedScene(random, size, pours, bodies);
    change(scene);
    compareEdits(random, scene);
  }
}

TEST_F(CudaEdits, OfSandAlone) {
  compareScenes(1, 0, [](RandomScene&) {});
}

TEST_F(CudaEdits, AmongBodies) {
  compareScenes(0, 2, [](RandomScene&) {});
}

TEST_F(CudaEdits, UnderBodiesThatHoverFarAbove) {
  compareScenes(0, 2, [](RandomScene& scene) {
    for (RandomBody& body : scene.bodies) lift(scene, body);
  });
}

TEST_F(CudaEdits, WhereABodyComesDownFromFarAbove) {
  compareScenes(0, 2, [](RandomScene& scene) {
    RandomBody& body = scene.bodies.front();
    body.motion.front().pose.translation().z() = highAbove(scene);
    body.motion[1].pose.translation().z() = highAbove(scene);
  });
}

TEST_F(CudaEdits, AmongBodiesThatOnlyDrag) {
  compareScenes(0, 2, [](RandomScene& scene) { scene.sand.parameters.coupling = Coupling::drag; });
}

/// Bodies that were added have no pose, and are nowhere.
TEST_F(CudaEdits, BesideBodiesThatAreNowhere) {
  compareScenes(0, 2, [](RandomScene& scene) {
    for (RandomBody& body : scene.bodies) body.motion.clear();
  });
}

}  // namespace
}  // namespace shallow_sand
