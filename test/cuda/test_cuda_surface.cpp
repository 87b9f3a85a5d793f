#include <gtest/gtest.h>

#include <cstring>

#include "parity.h"
#include "shallow_sand/surface/surface_mesh.h"

namespace shallow_sand {
namespace {

using CudaSurface = CudaTest;

template <class T>
bool sameBytes(const std::vector<T>& one, const std::vector<T>& other) {
  return one.size() == other.size() && std::memcmp(one.data(), other.data(), one.size() * sizeof(T)) == 0;
}

void expectSameMesh(const SurfaceMesh& one, const SurfaceMesh& other) {
  EXPECT_TRUE(sameBytes(one.positions, other.positions));
  EXPECT_TRUE(sameBytes(one.normals, other.normals));
  EXPECT_TRUE(sameBytes(one.materials, other.materials));
  EXPECT_EQ(one.sand, other.sand);
  EXPECT_EQ(one.bed, other.bed);
  EXPECT_EQ(one.loads, other.loads);
}

/// A plate deep in the sand comes up and carries some.
RandomScene liftedSand(std::mt19937& random) {
  RandomScene scene = tiltedScene(random, {24, 14}, 0, 0);
  const double spacing = scene.sand.parameters.grid.spacing;
  RandomBody plate;
  plate.shape = Box{{8.0 * spacing, 6.0 * spacing, 2.0 * spacing}};
  const TriangleMesh mesh = triangulate(plate.shape);
  plate.field =
      std::make_shared<const DistanceField>(computeDistanceField(mesh, distanceSpacing(mesh, spacing)));
  const Eigen::Vector2d place = randomPlace(random, scene.sand.parameters.grid.grid(), 5.0 * spacing);
  for (float& depth : scene.sand.depth) depth += static_cast<float>(10.0 * spacing);
  const double bottom = bedNear(scene.sand, place) + 2.0 * spacing;
  const Eigen::Quaterniond level = Eigen::Quaterniond::Identity();
  plate.motion = {{0.0, poseOf(place, bottom, level)},
                  {4.0 * scene.frame, poseOf(place, bottom + 12.0 * spacing, level)}};
  scene.bodies = {plate};
  return scene;
}

TEST_F(CudaSurface, IsThatOfTheCpu) {
  std::mt19937 random = seededGenerator();
  const RandomScene scene = liftedSand(random);
  Pair pair(scene);
  bool carried = false;
  for (int frame = 0; frame < 6 && !HasFailure(); ++frame) {
    pair.advance(scene.frame, 1);
    const Grid& grid = pair.cpu.grid();
    const Fields cpu = pair.cpu.fields();
    const Fields cuda = pair.cuda.fields();
    const SurfaceMesh mesh = surfaceMesh(grid, cuda);
    expectSameMesh(surfaceMesh(grid, cpu), mesh);
    EXPECT_TRUE(sameBytes(visibleColours(grid, cpu), visibleColours(grid, cuda)));
    carried = carried || !mesh.loads.empty();
  }
  EXPECT_TRUE(carried);
}

}  // namespace
}  // namespace shallow_sand
