#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <vector>

namespace shallow_sand {

/// Where sand is laid.
struct Column {
  std::size_t cell = 0;
  Eigen::Vector2d centre;  ///< of the cell, in the frame of the grid [m]
  double bed = 0.0;        ///< elevation [m]
};

/// One entry of `sand`: the depth in a column after it [m], from the depth before it [m]. The result may be
/// negative; who calls refuses that.
using SandLayer = std::function<double(const Column& column, double depth)>;

/// Adds `added` [m] everywhere; takes away where it is negative, as do the others.
SandLayer evenLayer(double added);
/// Fills up to an elevation [m]; sand above it stays.
SandLayer fillToSurface(double elevation);
/// The same two with a number for each cell.
SandLayer unevenLayer(std::vector<float> added);
SandLayer fillToSurfaces(std::vector<float> elevations);
/// Adds `added` [m] to cells with minimum ≤ centre < maximum, so boxes that touch share no cell.
SandLayer boxLayer(const Eigen::Vector2d& minimum, const Eigen::Vector2d& maximum, double added);
/// Adds `added` [m] to cells whose centre lies within `radius` [m].
SandLayer cylinderLayer(const Eigen::Vector2d& middle, double radius, double added);
/// Adds a cone of this height [m] at its axis and this slope (rise over run).
SandLayer coneLayer(const Eigen::Vector2d& middle, double height, double slope);

}  // namespace shallow_sand
