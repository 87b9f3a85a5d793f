#pragma once

#include <string>

namespace shallow_sand {

/// Every key of a scene file that is available, once.
inline const std::string kFullScene =
    R"(grid:     {size: [4.0, 2.0], spacing: 0.02, origin: [0.0, 0.0], frame: sand}
gravity:  [0.0, 0.0, -9.81]
material: {friction_angle: 32.0, dilute_layer: {fraction: 1.0, depth: 0.1}}
edges:    {x_min: wall, x_max: wall, y_min: open, y_max: wall}
bed:      {elevation: 0.0, slope: [0.0, 0.0]}
sand:
  - {depth: 0.3}
  - {surface: 0.4}
  - {cylinder: {center: [1.0, 1.0], radius: 0.5, depth: 1.0}}
  - {box: {min: [0.0, 0.0], max: [1.0, 2.0], depth: 0.4}}
  - {cone: {center: [2.0, 1.0], height: 1.0, slope_angle: 30.0}}
pours:    [{position: [2.0, 1.0], radius: 0.1, rate: 0.01, start: 0.0, stop: 8.0}]
bodies:
  - name: blade
    shape: {box: [0.1, 1.0, 0.5]}
    motion:
      - {time: 0.0, position: [0.6, 1.0, 0.45], rpy: [0, 0, 0]}
      - {time: 8.0, position: [2.2, 1.0, 0.45], rpy: [0, 0, 90]}
  - name: roller
    shape: {cylinder: {radius: 0.2, length: 0.5}}
    motion: [{time: 0.0, position: [3.0, 1.0, 2.0]}]
  - name: ball
    shape: {sphere: 0.2}
    motion: [{time: 0.0, position: [3.0, 1.0, 3.0]}]
solver:   {reconstruction: constant, courant: 0.45, max_step: 0.01, fixed_step: 0.002, coupling: drag}
duration: 10.0
backend: cpu
threads: 2
grains:   {per_cell: 2, layers: 3, speed: dilute, color: layer}
)";

}  // namespace shallow_sand
