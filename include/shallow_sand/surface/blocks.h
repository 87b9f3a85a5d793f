#pragma once

#include <cstddef>
#include <vector>

#include "shallow_sand/core/fields.h"
#include "shallow_sand/core/grid.h"

namespace shallow_sand {

/// Columns and rows of cells, or of blocks of cells, in the order of Fields. They need not be of one size.
struct Lattice {
  std::vector<double> x;       ///< middles of the columns, in the grid's frame [m]
  std::vector<double> y;       ///< of the rows [m]
  std::vector<double> width;   ///< of each column along x [m]
  std::vector<double> height;  ///< of each row along y [m]

  std::size_t columns() const { return x.size(); }
  std::size_t rows() const { return y.size(); }
  std::size_t cells() const { return x.size() * y.size(); }
  std::size_t index(std::size_t i, std::size_t j) const { return j * x.size() + i; }
  double area(std::size_t i, std::size_t j) const { return width[i] * height[j]; }  ///< [m²]
};

/// A grid by blocks of 2^level × 2^level cells; the last column and the last row may be narrower.
Lattice blocksOf(const Grid& grid, int level);

/// Bed, depth and load of each block: means over its cells, so that volumes stay. A load's elevation is that
/// of the load's sand. Momentum is left out.
Fields blockMeans(const Grid& grid, const Fields& fields, int level);

/// The finest level with at most so many blocks, or with one block.
int finestLevel(const Grid& grid, std::size_t most_blocks);

}  // namespace shallow_sand
