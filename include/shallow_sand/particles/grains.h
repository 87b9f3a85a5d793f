#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "shallow_sand/particles/grain.h"

namespace shallow_sand {

/// All grains of a map at one time.
struct Grains {
  Grains() = default;
  /// None of them yet.
  Grains(const GrainParameters& parameters, const Grid& of_sand)
      : grid(parameters, of_sand), color(parameters.color) {}

  GrainGrid grid;
  GrainColor color = GrainColor::origin;
  std::uint32_t moves = 0;   ///< so far
  std::vector<Grain> cells;  ///< laid out as in GrainGrid; empty if there are none
};

/// Grains that are seen.
struct GrainCloud {
  std::vector<Eigen::Vector3f> points;  ///< in the grid's frame (Eq. 33) [m]
  std::vector<Eigen::Vector3f> colors;  ///< red, green, blue from 0 to 1
  float spacing = 0.0f;                 ///< Δl [m]
};

/// Where grains are seen that are in sand: neither where that is thinner than a tenth of ΔL nor below the
/// bed (section 6.3). Where sand lies on bodies, they are in that. The fields are those of the same time.
GrainCloud grainCloud(const Grid& grid, const Fields& fields, const Grains& grains);

}  // namespace shallow_sand
