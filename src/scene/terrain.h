#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "shallow_sand/core/grid.h"

namespace shallow_sand {

/// Bound on the size of all numbers of a scene.
constexpr double kLargestNumber = 1e9;

/// A map of numbers in an image file, and how it lies on the grid.
struct TerrainParameters {
  std::string file;                       ///< path of a GeoTIFF, an ESRI ASCII grid or a PNG
  std::string band;                       ///< its description or number, counted from 1; empty: the first
  std::optional<Eigen::Vector2d> origin;  ///< corner with the smallest x and y, instead of the file's [m]
  std::optional<Eigen::Vector2d> size;    ///< extent along x and y, instead of the file's [m]
  std::optional<double> scale;            ///< factor on the file's numbers, instead of the file's own
  std::optional<double> offset;           ///< added to them then, instead of the file's own
  std::optional<double> no_data;          ///< for cells that the file says nothing about; none: refuse them
};

/// One number for each cell, laid out as in Fields: along each axis that of the pixel with which the cell
/// coincides, to the bit, or the mean of those that it covers, or linear between two. The file has no data
/// for a cell whose centre lies beside it, or when less than half of what would make up its number is there.
/// A file without a place of its own spans the grid.
/// @throws InvalidParameter with the key `file` or `band`
std::vector<float> readTerrain(const TerrainParameters& parameters, const Grid& grid);

/// What a file says about a cell, for errors: "gives NUMBER at (X, Y)".
std::string givesText(double value, const Grid& grid, std::size_t cell);

}  // namespace shallow_sand
