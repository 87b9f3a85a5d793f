#include <gtest/gtest.h>

#include <algorithm>

#include "shallow_sand/surface/surface_mesh.h"
#include "surface/mesh_figures.h"

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

TEST(LoadsMesh, IsASheetOfItsOwn) {
  const Carried scene;
  const SurfaceMesh mesh = surfaceMesh(scene.grid, scene.fields);
  EXPECT_EQ(mesh.loads.size(), 2u);  // between four cells
  EXPECT_NEAR(footprintOf(mesh, mesh.loads), scene.grid.cellArea(), 1e-9);
  for (const auto& triangle : mesh.loads) {
    for (const std::uint32_t corner : triangle) {
      EXPECT_GE(corner, scene.grid.cells());
      EXPECT_FLOAT_EQ(static_cast<float>(mesh.positions[corner].z()), 0.55f);
      EXPECT_EQ(mesh.normals[corner], Eigen::Vector3f::UnitZ());  // its rim is no slope
      EXPECT_EQ(mesh.materials[corner], SurfaceMaterial::sand);
    }
  }
}

TEST(LoadsMesh, GroundGoesOnUnderIt) {
  const Carried scene;
  const SurfaceMesh mesh = surfaceMesh(scene.grid, scene.fields);
  EXPECT_EQ(mesh.sand.size(), 2u * 5u * 5u);
  for (const auto& triangle : mesh.sand) {
    for (const std::uint32_t corner : triangle) {
      EXPECT_EQ(static_cast<float>(mesh.positions[corner].z()), 0.1f);
      EXPECT_EQ(mesh.normals[corner], Eigen::Vector3f::UnitZ());
    }
  }
}

TEST(LoadsMesh, IsJoinedToTheGroundWhereItLiesClose) {
  Carried scene;
  for (float& elevation : scene.fields.load_elevation) elevation = 0.15f;
  // The load's four cells and the twelve around them: nine squares, of two corners of which no load is near.
  EXPECT_EQ(surfaceMesh(scene.grid, scene.fields).loads.size(), 2u * 9u - 2u);
}

TEST(LoadsMesh, IsEmptyWithoutLoads) {
  Carried scene;
  scene.fields.load.clear();
  EXPECT_TRUE(surfaceMesh(scene.grid, scene.fields).loads.empty());
}

TEST(LoadsMesh, LoadsHaveTheColourOfSandAlsoOverBareBed) {
  Carried scene;
  scene.fields.depth.assign(scene.grid.cells(), 0.0f);
  scene.fields.load[scene.grid.index(2, 2)] = 0.005f;  // less than a tenth of a cell
  const std::vector<Eigen::Vector3f> colours = visibleColours(scene.grid, scene.fields);
  const Eigen::Vector3f up = Eigen::Vector3f::UnitZ();
  EXPECT_EQ(colours[scene.grid.index(3, 3)], surfaceColour(SurfaceMaterial::sand, up));
  EXPECT_GT(colours[scene.grid.index(2, 2)].x(), 1.3f * colours[scene.grid.index(2, 2)].z());
  EXPECT_EQ(colours[scene.grid.index(0, 0)], surfaceColour(SurfaceMaterial::bed, up));
}

}  // namespace
}  // namespace shallow_sand
