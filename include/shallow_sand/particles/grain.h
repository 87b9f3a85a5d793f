#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "shallow_sand/core/fields.h"
#include "shallow_sand/core/parameters.h"
#include "shallow_sand/core/types.h"

namespace shallow_sand {

/// A grain; where it is follows from the cell of J that holds it. Its depth follows from the last two, which
/// it keeps as long as there is one.
struct Grain {
  float x;               ///< offset in its cell, 0 ≤ x < 1 (Eq. 30) [Δl]
  float y;               ///< the same along y [Δl]
  std::uint32_t origin;  ///< cell of J that its sand was in at the start; kBare if there was no sand
  std::uint32_t born;    ///< move after which it was generated; 0 at the start

  /// Bit of `origin`: there was no sand.
  static constexpr std::uint32_t kBare = 1u << 31;

  SHALLOW_SAND_HOST_DEVICE bool isBare() const { return (origin & kBare) != 0; }
};

/// The grid of grains (paper: J, spacing Δl = ΔL/per_cell). Cell (s, t, d) is column s along x, row t along y
/// and layer d below the surface; each holds one grain. Lists are row-major, layer 0 first.
struct GrainGrid {
  int per_cell = 0;
  int layers = 0;
  int columns = 0;  ///< of J
  int rows = 0;
  std::uint64_t reciprocal = 0;  ///< 2^32 over per_cell, rounded up
  float spacing = 0.0f;          ///< Δl [m]

  GrainGrid() = default;
  GrainGrid(const GrainParameters& parameters, const Grid& grid)
      : per_cell(parameters.per_cell),
        layers(parameters.layers),
        columns(grid.columns * parameters.per_cell),
        rows(grid.rows * parameters.per_cell),
        reciprocal(((1ull << 32) + static_cast<unsigned>(parameters.per_cell) - 1) /
                   static_cast<unsigned>(parameters.per_cell)),
        spacing(grid.spacing / static_cast<float>(parameters.per_cell)) {}

  SHALLOW_SAND_HOST_DEVICE long long cells() const { return static_cast<long long>(columns) * rows * layers; }
  SHALLOW_SAND_HOST_DEVICE long long index(int s, int t, int d) const {
    return (static_cast<long long>(d) * rows + t) * columns + s;
  }
  /// Column of I that holds a column of J, or row that holds a row: a division, exact up to 2^26.
  SHALLOW_SAND_HOST_DEVICE int cellOfSand(int cell) const {
    return static_cast<int>(static_cast<std::uint64_t>(cell) * reciprocal >> 32);
  }
};

/// The largest float below 1.
constexpr float kBelowOne = 0.99999994f;

/// Bits without a pattern from a number: the finaliser of SplitMix64 (Steele, Lea and Flood 2014).
SHALLOW_SAND_HOST_DEVICE inline std::uint64_t scrambled(std::uint64_t bits) {
  bits += 0x9E3779B97F4A7C15ull;
  bits = (bits ^ (bits >> 30)) * 0xBF58476D1CE4E5B9ull;
  bits = (bits ^ (bits >> 27)) * 0x94D049BB133111EBull;
  return bits ^ (bits >> 31);
}
/// R(0, 1) of Eq. 30, from 24 of these bits: 0 ≤ R < 1.
SHALLOW_SAND_HOST_DEVICE inline float unitFrom(std::uint64_t bits) {
  return static_cast<float>(static_cast<std::uint32_t>(bits >> 40)) * (1.0f / 16777216.0f);
}

/// Of a grain that is generated in a cell of J after a move (Eq. 30).
SHALLOW_SAND_HOST_DEVICE inline Grain generatedGrain(std::uint32_t cell, std::uint32_t move,
                                                     std::uint32_t origin) {
  const std::uint64_t counter = 2 * ((static_cast<std::uint64_t>(move) << 26) + cell);
  return {unitFrom(scrambled(counter)), unitFrom(scrambled(counter + 1)), origin, move};
}

/// What tells a grain from others as long as there is one.
SHALLOW_SAND_HOST_DEVICE inline std::uint64_t bitsOf(const Grain& grain) {
  return scrambled(scrambled(grain.origin) + grain.born);
}
/// z_p of a grain in a layer (Eq. 30): how deep it is below the surface. [m]
SHALLOW_SAND_HOST_DEVICE inline float depthOf(const Grain& grain, int layer, float spacing) {
  return (static_cast<float>(layer) + unitFrom(bitsOf(grain))) * spacing;
}

/// The grains of sand that has not moved yet.
std::vector<Grain> startingGrains(const GrainGrid& grains, const Grid& grid, const Fields& fields);

}  // namespace shallow_sand
