#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "shallow_sand/sim/simulator.h"

namespace shallow_sand {

inline double uniform(std::mt19937& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

/// A sum of a few random waves with lengths from four cells to the whole grid, between -1 and 1.
inline std::vector<float> randomWaves(std::mt19937& random, const Grid& grid) {
  struct Wave {
    double kx, ky, phase;
  };
  std::vector<Wave> waves(6);
  for (Wave& wave : waves) {
    const double length = grid.spacing * std::exp(uniform(random, std::log(4.0), std::log(4.0 + grid.columns)));
    const double heading = uniform(random, 0.0, 2.0 * M_PI);
    wave = {2.0 * M_PI / length * std::cos(heading), 2.0 * M_PI / length * std::sin(heading),
            uniform(random, 0.0, 2.0 * M_PI)};
  }
  std::vector<float> values(grid.cells());
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      double value = 0.0;
      for (const Wave& wave : waves) value += std::sin(wave.kx * grid.x(i) + wave.ky * grid.y(j) + wave.phase);
      values[grid.index(i, j)] = static_cast<float>(value / static_cast<double>(waves.size()));
    }
  }
  return values;
}

/// Parameters and fields of a valid simulation: uneven bed with rocks that stand out, dry ground, steep sand.
struct RandomSand {
  SimulatorParameters parameters;
  std::vector<float> bed;
  std::vector<float> depth;
};

inline RandomSand randomSand(std::mt19937& random, int columns, int rows) {
  RandomSand sand;
  const double spacing = std::exp(uniform(random, std::log(0.005), std::log(0.2)));
  sand.parameters.grid.spacing = spacing;
  sand.parameters.grid.size = {columns * spacing, rows * spacing};
  sand.parameters.grid.origin = {uniform(random, -10.0, 10.0), uniform(random, -10.0, 10.0)};
  sand.parameters.material.friction_angle = uniform(random, 5.0, 60.0) * M_PI / 180.0;
  sand.parameters.material.layer_fraction = uniform(random, 0.3, 1.0);
  sand.parameters.material.layer_depth =
      random() % 3 == 0 ? std::numeric_limits<double>::infinity() : uniform(random, 1.0, 20.0) * spacing;
  sand.parameters.backend = Backend::cpu;
  sand.parameters.threads = 1;
  const Grid grid = sand.parameters.grid.grid();
  sand.bed = randomWaves(random, grid);
  sand.depth = randomWaves(random, grid);
  const float bed_scale = static_cast<float>(uniform(random, 0.0, 5.0) * spacing);
  const float depth_scale = static_cast<float>(uniform(random, 2.0, 20.0) * spacing);
  for (float& b : sand.bed) b *= bed_scale;
  for (float& h : sand.depth) h = std::max(0.0f, h * depth_scale);
  return sand;
}

inline Edges randomEdges(std::mt19937& random) {
  const auto edge = [&] { return random() % 2 == 0 ? Edge::wall : Edge::open; };
  return {edge(), edge(), edge(), edge()};
}

}  // namespace shallow_sand
