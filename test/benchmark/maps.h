#pragma once

#include <cmath>
#include <vector>

#include "shallow_sand/sim/simulator.h"

namespace shallow_sand {

/// What a simulator starts from.
struct Map {
  SimulatorParameters parameters;
  std::vector<float> bed;
  std::vector<float> depth;

  Simulator simulator() const { return Simulator(parameters, bed, depth); }
};

inline Map onBackend(Backend backend, Map map) {
  map.parameters.backend = backend;
  return map;
}

inline SimulatorParameters parametersOf(int side, int threads) {
  constexpr double kSpacing = 0.02;
  SimulatorParameters parameters;
  parameters.backend = Backend::cpu;
  parameters.grid.spacing = kSpacing;
  parameters.grid.size = {side * kSpacing, side * kSpacing};
  parameters.threads = threads;
  return parameters;
}

/// Sand without friction sloshes for ever in a square pit: each of its cells moves in every step. Around the
/// pit, which begins `corner` cells from both edges of the map, is high bare ground.
inline Map sloshingPit(int map_side, int pit_side, int corner, int threads) {
  Map map;
  map.parameters = parametersOf(map_side, threads);
  map.parameters.material.friction_angle = 0.0;
  map.parameters.gravity = {0.5, 0.3, -9.81};
  const std::size_t cells = static_cast<std::size_t>(map_side) * map_side;
  map.bed.assign(cells, 5.0f);
  map.depth.assign(cells, 0.0f);
  for (int j = 0; j < pit_side; ++j) {
    for (int i = 0; i < pit_side; ++i) {
      const std::size_t at = static_cast<std::size_t>(corner + j) * map_side + corner + i;
      map.bed[at] = 0.05f * std::sin(0.11f * i) * std::sin(0.07f * j);
      map.depth[at] = 1.0f + 0.1f * std::sin(0.05f * i + 0.09f * j);
    }
  }
  return map;
}

inline Map sloshingSand(int side, int threads) { return sloshingPit(side, side, 0, threads); }

/// Level sand that friction holds.
inline Map restingSand(int side, int threads, Edge edge) {
  const std::size_t cells = static_cast<std::size_t>(side) * side;
  Map map{parametersOf(side, threads), std::vector<float>(cells, 0.0f), std::vector<float>(cells, 0.3f)};
  map.parameters.edges = {edge, edge, edge, edge};
  return map;
}

}  // namespace shallow_sand
