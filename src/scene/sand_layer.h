#pragma once

#include <Eigen/Core>
#include <functional>

namespace shallow_sand {

/// One entry of `sand`: the depth at a cell after it [m], from the cell's centre [m, frame of the grid], its
/// bed's elevation [m] and the depth before it [m]. The result may be negative; who calls refuses that.
using SandLayer = std::function<double(const Eigen::Vector2d& centre, double bed, double depth)>;

/// Adds `added` [m] everywhere; takes away where it is negative, as do the others.
SandLayer evenLayer(double added);
/// Fills up to an elevation [m]; sand above it stays.
SandLayer fillToSurface(double elevation);
/// Adds `added` [m] to cells with minimum ≤ centre < maximum, so boxes that touch share no cell.
SandLayer boxLayer(const Eigen::Vector2d& minimum, const Eigen::Vector2d& maximum, double added);
/// Adds `added` [m] to cells whose centre lies within `radius` [m].
SandLayer cylinderLayer(const Eigen::Vector2d& middle, double radius, double added);
/// Adds a cone of this height [m] at its axis and this slope (rise over run).
SandLayer coneLayer(const Eigen::Vector2d& middle, double height, double slope);

}  // namespace shallow_sand
