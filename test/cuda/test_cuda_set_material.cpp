#include <gtest/gtest.h>

#include <string>

#include "parity.h"
#include "random_material.h"

namespace shallow_sand {
namespace {

using CudaSetMaterial = CudaTest;

/// New sand, new gravity or both before every other frame.
void compareChanges(std::mt19937& random, const RandomScene& scene) {
  Pair pair(scene);
  for (int frame = 0; frame < 8 && !::testing::Test::HasFailure(); ++frame) {
    const unsigned which = random() % 6;
    if (which & 1) {
      const Material material = otherMaterial(random, pair.cpu, scene.sand.material);
      pair.both([&](Simulator& simulator) { simulator.setMaterial(material); });
    }
    if (which & 2) {
      const Eigen::Vector3d gravity = otherGravity(random);
      pair.both([&](Simulator& simulator) { simulator.setGravity(gravity); });
    }
    SCOPED_TRACE("change " + std::to_string(which) + " before frame " + std::to_string(frame));
    pair.advance(scene.frame, 1);
  }
  expectSteps(pair.steps(), 8);
}

void compareScenes(int pours, int bodies) {
  std::mt19937 random = seededGenerator();
  for (const Size& size : {Size{1, 6}, Size{33, 5}, Size{20, 12}}) {
    SCOPED_TRACE(std::to_string(size.columns) + " x " + std::to_string(size.rows));
    compareChanges(random, tiltedScene(random, size, pours, bodies));
  }
}

TEST_F(CudaSetMaterial, OfSandAlone) { compareScenes(1, 0); }

TEST_F(CudaSetMaterial, AmongBodies) { compareScenes(0, 2); }

/// It sleeps until friction no longer holds it.
TEST_F(CudaSetMaterial, OfSandAtRest) {
  std::mt19937 random = seededGenerator();
  RandomScene scene = sceneOf(random, heldSand(random, 40, 20));
  Pair pair(scene);
  pair.advance(scene.frame, 3);
  Material slick = scene.sand.parameters.material;
  slick.friction_angle = 0.0;
  pair.both([&](Simulator& simulator) { simulator.setMaterial(slick); });
  pair.advance(scene.frame, 4);
  EXPECT_GT(pair.cuda.activeCells(), 0u);
}

}  // namespace
}  // namespace shallow_sand
