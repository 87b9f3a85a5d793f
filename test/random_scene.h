#pragma once

#include <string>
#include <utility>
#include <vector>

#include "random_bodies.h"
#include "random_fields.h"

namespace shallow_sand {

/// Everything that a simulation can hold.
struct RandomScene {
  RandomSand sand;
  std::vector<Pour> pours;
  std::vector<RandomBody> bodies;
  double frame = 0.0;  ///< time of a few steps, to advance by [s]
};

/// A pour, or a drain, that starts and stops within ten frames.
inline Pour randomPour(std::mt19937& random, const RandomScene& scene) {
  const double spacing = scene.sand.parameters.grid.spacing;
  Pour pour;
  pour.position = randomPlace(random, scene.sand.parameters.grid.grid(), 0.0);
  pour.radius = uniform(random, 0.1, 6.0) * spacing;
  pour.rate = uniform(random, -5.0, 10.0) * spacing * spacing * spacing / scene.frame;
  pour.start = uniform(random, 0.0, 2.0) * scene.frame;
  pour.stop = pour.start + uniform(random, 1.0, 8.0) * scene.frame;
  return pour;
}

/// Adds all edges, tilted gravity, both reconstructions and, in every other scene, material that varies; and
/// pours and bodies that move, some of which stop within ten frames.
inline RandomScene randomScene(std::mt19937& random, RandomSand sand, int pours, int bodies) {
  RandomScene scene;
  SimulatorParameters& parameters = sand.parameters;
  parameters.edges = randomEdges(random);
  parameters.solver.courant = uniform(random, 0.2, 0.9);
  parameters.solver.max_step = 0.1;
  parameters.solver.reconstruction = random() % 2 == 0 ? Reconstruction::constant : Reconstruction::minmod;
  if (random() % 2 == 0) varyMaterial(random, sand);
  scene.frame = std::sqrt(parameters.grid.spacing / 9.81);
  scene.sand = std::move(sand);
  for (int k = 0; k < pours; ++k) scene.pours.push_back(randomPour(random, scene));
  for (int k = 0; k < bodies; ++k) {
    scene.bodies.push_back(randomBody(random, scene.sand.parameters.grid.spacing));
    moveThroughSand(random, scene.sand, uniform(random, 3.0, 12.0) * scene.frame, scene.bodies.back());
  }
  return scene;
}

/// A column of sand on what there is, twice as high as its radius [m].
inline void addHeap(RandomSand& sand, const Eigen::Vector2d& place, double radius) {
  const Grid grid = sand.parameters.grid.grid();
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      if (std::hypot(grid.x(i) - place.x(), grid.y(j) - place.y()) < radius)
        sand.depth[grid.index(i, j)] += static_cast<float>(2.0 * radius);
    }
  }
}

/// Sand alone, between walls, with either reconstruction.
inline RandomScene sceneOf(std::mt19937& random, RandomSand sand) {
  RandomScene scene;
  scene.frame = std::sqrt(sand.parameters.grid.spacing / 9.81);
  sand.parameters.solver.reconstruction =
      random() % 2 == 0 ? Reconstruction::constant : Reconstruction::minmod;
  scene.sand = std::move(sand);
  return scene;
}

/// The scene with some of its parameters changed.
inline Simulator simulatorOf(const RandomScene& scene, const SimulatorParameters& parameters) {
  Simulator simulator(parameters, scene.sand.bed, scene.sand.depth, scene.sand.material);
  for (const Pour& pour : scene.pours) simulator.addPour(pour);
  for (const RandomBody& body : scene.bodies) addTo(simulator, body);
  return simulator;
}

}  // namespace shallow_sand
