#include "benchmark/table1_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "benchmark/table1_scenes.h"

namespace shallow_sand {
namespace {

constexpr double kDegree = M_PI / 180.0;

/// The map of a row, without sand.
Scene emptySceneOf(const Table1Row& row, Backend backend) {
  Scene scene;
  scene.source = row.name;
  SimulatorParameters& parameters = scene.parameters;
  parameters.backend = backend;
  parameters.grid.spacing = row.spacing;
  parameters.grid.size = row.spacing * Eigen::Vector2d(row.columns, row.rows);
  parameters.material.friction_angle = row.friction_angle * kDegree;
  parameters.material.layer_depth = row.layer_depth * row.spacing;
  parameters.solver.fixed_step = row.fixed_step;
  if (!row.fixed_step) parameters.solver.courant = 0.1;
  const std::size_t cells = parameters.grid.grid().cells();
  scene.bed.assign(cells, 0.0f);
  scene.depth.assign(cells, 0.0f);
  return scene;
}

GrainParameters grainsOf(int per_cell, int layers) {
  GrainParameters grains;
  grains.per_cell = per_cell;
  grains.layers = layers;
  return grains;
}

}  // namespace

std::vector<Table1Row> table1Rows() {
  constexpr double kWhole = std::numeric_limits<double>::infinity();
  const std::string sketch = "t_d 4.8, t_i 4.1, t_p 70 ms";
  std::vector<Table1Row> rows = {
      {"figure_1_avalanche", 512, 512, 20, kWhole, {}, 0.02, fillAvalanche, "t_d 20 ms"},
      {"figure_1_butterfly", 256, 256, 30, 10, {}, 0.02, fillButterfly, sketch, grainsOf(4, 1)},
      {"figure_1_flattening", 256, 256, 30, 10, {}, 0.02, fillFlattening, sketch, grainsOf(4, 1)}};
  for (const int angle : {15, 30, 45, 60}) {
    const std::string name = "figure_5_pile_" + std::to_string(angle) + "_degrees";
    rows.push_back({name, 64, 64, 1.0 * angle, 5, 0.01, 0.5, fillPile, "t_d under 1 ms"});
  }
  // The paper's figure shows a third depth of the layer between these, which it does not tell.
  for (const int layer : {10, 40}) {
    const std::string name = "figure_6_layer_of_" + std::to_string(layer) + "_cells";
    rows.push_back({name, 256, 256, 30, 1.0 * layer, 0.01, 2.0, fillDamBreak, "t_d 1.6 ms"});
  }
  rows.push_back({"figure_9_shapes",
                  256,
                  256,
                  30,
                  10,
                  {},
                  0.02,
                  fillThreeShapes,
                  "t_d 4.8, t_i 3.8, t_p 11 ms",
                  grainsOf(4, 1)});
  rows.push_back({"figure_13_cars", 512, 256, 30, 10, {}, 0.02, fillCars, "t_d 10.3, t_i 5.8 ms"});
  rows.push_back({"figure_14_writing", 512, 256, 30, 10, 0.002, 0.02, fillWriting,
                  "t_d 5.1, t_i 4.1, t_p 9 ms", grainsOf(2, 1)});
  rows.push_back({"figure_15b_column",
                  64,
                  64,
                  30,
                  10,
                  {},
                  0.02,
                  fillTallColumn,
                  "t_d under 1 ms, t_p 65 ms",
                  grainsOf(2, 50)});
  rows.push_back(
      {"figure_16_fan", 128, 128, 30, 10, {}, 0.02, fillFan, "t_d 1.6, t_i 1.2, t_p 17 ms", grainsOf(4, 1)});
  return rows;
}

Scene sceneOf(const Table1Row& row, Backend backend) {
  Scene scene = emptySceneOf(row, backend);
  row.fill(scene);
  return scene;
}

Scene sloshingSandOf(const Table1Row& row, Backend backend) {
  Scene scene = emptySceneOf(row, backend);
  scene.parameters.material.friction_angle = 0.0;
  scene.parameters.gravity = {0.5, 0.3, -9.81};
  const double level =
      row.spacing * std::max(15.0, std::isfinite(row.layer_depth) ? 1.25 * row.layer_depth : 0.0);
  const Grid grid = scene.parameters.grid.grid();
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      const double wave = 1.0 + 0.1 * std::sin(0.05 * i + 0.09 * j);
      scene.depth[grid.index(i, j)] = static_cast<float>(level * wave);
    }
  }
  return scene;
}

}  // namespace shallow_sand
