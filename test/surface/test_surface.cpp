#include <gtest/gtest.h>

#include <algorithm>

#include "shallow_sand/surface/surface.h"

namespace shallow_sand {
namespace {

/// Level sand of 0.1 m; a body at 0.5 m carries 0.05 m over the four cells in the middle.
struct Carried {
  Grid grid{6, 6, 0.1f, 0.0, 0.0};
  Fields fields;

  Carried() {
    const std::vector<float> none(grid.cells(), 0.0f);
    fields.bed = fields.momentum_x = fields.momentum_y = fields.load = fields.load_elevation = none;
    fields.depth.assign(grid.cells(), 0.1f);
    for (const int j : {2, 3}) {
      for (const int i : {2, 3}) {
        fields.load[grid.index(i, j)] = 0.05f;
        fields.load_elevation[grid.index(i, j)] = 0.5f;
      }
    }
  }
};

TEST(Surface, LoadsAreASheetOfTheirOwn) {
  const Carried scene;
  const std::vector<std::size_t> loads = loadTriangles(scene.grid, scene.fields);
  EXPECT_EQ(loads.size(), 6u);  // two triangles between four cells
  for (const std::size_t corner : loads) EXPECT_TRUE(scene.fields.hasLoad(corner));
  const Surface visible = visibleSurface(scene.grid, scene.fields);
  EXPECT_FLOAT_EQ(visible.points[loads[0]].z(), 0.55f);
}

TEST(Surface, GroundGoesOnUnderLoads) {
  const Carried scene;
  const Surface ground = groundSurface(scene.grid, scene.fields);
  EXPECT_TRUE(std::all_of(ground.points.begin(), ground.points.end(),
                          [](const Eigen::Vector3f& point) { return point.z() == 0.1f; }));
}

TEST(Surface, ALoadThatLiesCloseOverTheGroundIsJoinedToIt) {
  Carried scene;
  for (float& elevation : scene.fields.load_elevation) elevation = 0.15f;
  // The load's four cells and the twelve around them: nine squares, of two corners of which no load is near.
  EXPECT_EQ(loadTriangles(scene.grid, scene.fields).size(), 6u * 9u - 3u * 2u);
}

TEST(Surface, NothingIsCarriedWhereThereAreNoLoads) {
  Carried scene;
  scene.fields.load.clear();
  EXPECT_TRUE(loadTriangles(scene.grid, scene.fields).empty());
}

}  // namespace
}  // namespace shallow_sand
