#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
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
    const double length =
        grid.spacing * std::exp(uniform(random, std::log(4.0), std::log(4.0 + grid.columns)));
    const double heading = uniform(random, 0.0, 2.0 * M_PI);
    wave = {2.0 * M_PI / length * std::cos(heading), 2.0 * M_PI / length * std::sin(heading),
            uniform(random, 0.0, 2.0 * M_PI)};
  }
  std::vector<float> values(grid.cells());
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      double value = 0.0;
      for (const Wave& wave : waves)
        value += std::sin(wave.kx * grid.x(i) + wave.ky * grid.y(j) + wave.phase);
      values[grid.index(i, j)] = static_cast<float>(value / static_cast<double>(waves.size()));
    }
  }
  return values;
}

inline bool sameBits(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

inline void expectSameBits(const Fields& a, const Fields& b) {
  EXPECT_TRUE(sameBits(a.bed, b.bed));
  EXPECT_TRUE(sameBits(a.depth, b.depth));
  EXPECT_TRUE(sameBits(a.momentum_x, b.momentum_x));
  EXPECT_TRUE(sameBits(a.momentum_y, b.momentum_y));
  EXPECT_TRUE(sameBits(a.load, b.load));
  EXPECT_TRUE(sameBits(a.load_elevation, b.load_elevation));
  EXPECT_TRUE(sameBits(a.load_momentum_x, b.load_momentum_x));
  EXPECT_TRUE(sameBits(a.load_momentum_y, b.load_momentum_y));
}

/// A size in cells.
struct Size {
  int columns;
  int rows;
};

/// A whole number from `least` to `most`.
inline int randomCount(std::mt19937& random, int least, int most) {
  return least + static_cast<int>(random() % static_cast<unsigned>(most - least + 1));
}

/// Gravity that leans by at most `most` along each axis. [m/s²]
inline Eigen::Vector3d randomGravity(std::mt19937& random, double most) {
  const double x = uniform(random, -most, most);
  return {x, uniform(random, -most, most), -9.81};
}

/// Parameters and fields of a valid simulation: uneven bed with rocks that stand out, dry ground, steep sand.
struct RandomSand {
  SimulatorParameters parameters;
  std::vector<float> bed;
  std::vector<float> depth;
  MaterialFields material;  ///< empty unless varyMaterial has filled it
};

/// Sand of other kinds here and there: friction between 5° and 60°, layers of any kind. Each of the three
/// lists may stay empty.
inline void varyMaterial(std::mt19937& random, RandomSand& sand) {
  const Grid grid = sand.parameters.grid.grid();
  const auto field = [&](double low, double high) {
    std::vector<float> values = randomWaves(random, grid);
    for (float& value : values)
      value = static_cast<float>(0.5 * (low + high) + 0.5 * (high - low) * static_cast<double>(value));
    return values;
  };
  const unsigned which = 1 + random() % 7;
  if (which & 1) sand.material.friction_angle = field(5.0 * M_PI / 180.0, 60.0 * M_PI / 180.0);
  if (which & 2) sand.material.layer_fraction = field(0.3, 1.0);
  if (which & 4)
    sand.material.layer_depth = field(sand.parameters.grid.spacing, 20.0 * sand.parameters.grid.spacing);
}

/// Of 1 to 40 cells each way; its origin's coordinates lie within `reach` [m] of 0.
inline Grid gridAnywhere(std::mt19937& random, double reach) {
  Grid grid;
  grid.columns = 1 + static_cast<int>(random() % 40);
  grid.rows = 1 + static_cast<int>(random() % 40);
  grid.spacing = static_cast<float>(uniform(random, 0.01, 0.5));
  grid.origin_x = uniform(random, -reach, reach);
  grid.origin_y = uniform(random, -reach, reach);
  return grid;
}

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

/// A random surface that friction holds: from a cell to the next it rises by at most 0.67 μ ΔL along each
/// axis, so its slope is at most 0.95 μ; above an uneven bed that stands out of it here and there, the less
/// the more cells the surface is lifted; in tilted gravity.
inline RandomSand heldSand(std::mt19937& random, int columns, int rows, double lifted_cells = 0.0) {
  RandomSand sand = randomSand(random, columns, rows);
  const Grid grid = sand.parameters.grid.grid();
  const double friction = std::tan(sand.parameters.material.friction_angle);
  sand.parameters.gravity = randomGravity(random, 3.0);
  std::vector<float> surface = randomWaves(random, grid);
  double steepest = 1e-6;
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      const double own = surface[grid.index(i, j)];
      if (i > 0) steepest = std::max(steepest, std::abs(own - surface[grid.index(i - 1, j)]));
      if (j > 0) steepest = std::max(steepest, std::abs(own - surface[grid.index(i, j - 1)]));
    }
  }
  const double scale = 0.67 * friction * grid.spacing / steepest;
  const double lift = lifted_cells * grid.spacing;
  const Eigen::Vector3d& g = sand.parameters.gravity;
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      const std::size_t k = grid.index(i, j);
      const double level = -(g.x() * i + g.y() * j) * grid.spacing / g.z();
      sand.bed[k] = 2.0f * sand.bed[k] + static_cast<float>(level);
      sand.depth[k] = std::max(0.0f, static_cast<float>(scale * surface[k] + level + lift) - sand.bed[k]);
    }
  }
  return sand;
}

inline Edges randomEdges(std::mt19937& random) {
  const auto edge = [&] { return random() % 2 == 0 ? Edge::wall : Edge::open; };
  return {edge(), edge(), edge(), edge()};
}

}  // namespace shallow_sand
