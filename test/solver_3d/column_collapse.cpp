#include "solver_3d/column_collapse.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>

namespace shallow_sand {

Scene Column::scene(int threads) const {
  YAML::Node file = YAML::LoadFile(SHALLOW_SAND_SOURCE_DIR "/config/scenes/tall_column.yaml");
  file["grid"]["spacing"] = spacing;
  file["material"]["dilute_layer"]["depth"] = layer;
  file["sand"][0]["cylinder"]["depth"] = height;
  file.remove("grains");
  Scene scene = readScene(file, "tall_column");
  scene.parameters.backend = Backend::cpu;
  scene.parameters.threads = threads;
  return scene;
}

MaterialPoints Column::points(int threads) const {
  const Scene like = scene(threads);
  const Grid grid = like.parameters.grid.grid();
  MaterialPointParameters parameters;
  parameters.cells = {grid.columns, grid.rows, grid.columns};
  parameters.spacing = spacing;
  parameters.gravity = like.parameters.gravity;
  parameters.friction_angle = like.parameters.material.friction_angle;
  parameters.youngs_modulus = youngs_modulus;
  parameters.threads = threads;
  MaterialPoints points(parameters);
  points.fill({like.depth.begin(), like.depth.end()});
  return points;
}

Profile radialProfile(const Grid& grid, const std::vector<double>& depth) {
  const double spacing = grid.spacing;
  const auto rings = static_cast<std::size_t>(std::min(grid.columns, grid.rows) / 2);
  std::vector<double> cells(rings, 0.0);
  Profile profile;
  profile.depth.assign(rings, 0.0);
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      const double radius = std::hypot(i + 0.5 - 0.5 * grid.columns, j + 0.5 - 0.5 * grid.rows);
      const auto ring = static_cast<std::size_t>(radius);
      if (ring >= rings) continue;
      cells[ring] += 1.0;
      profile.depth[ring] += depth[grid.index(i, j)];
    }
  }
  for (std::size_t ring = 0; ring < rings; ++ring) {
    profile.x.push_back((static_cast<double>(ring) + 0.5) * spacing);
    profile.depth[ring] /= cells[ring];
  }
  return profile;
}

Profile radialProfile(const Simulator& simulator) {
  const Fields fields = simulator.fields();
  return radialProfile(simulator.grid(), {fields.depth.begin(), fields.depth.end()});
}

double relativeDeviation(const Profile& profile, const Profile& reference) {
  double difference = 0.0;
  double total = 0.0;
  for (std::size_t k = 0; k < reference.x.size(); ++k) {
    difference += reference.x[k] * std::abs(profile.depth[k] - reference.depth[k]);
    total += reference.x[k] * reference.depth[k];
  }
  return difference / total;
}

}  // namespace shallow_sand
