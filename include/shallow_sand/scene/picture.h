#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "shallow_sand/bodies/shape.h"
#include "shallow_sand/core/grid.h"
#include "shallow_sand/particles/grains.h"
#include "shallow_sand/sim/simulator.h"

namespace shallow_sand {

/// Corners of a closed line on the map, in the grid's frame. [m]
using Outline = std::vector<Eigen::Vector2d>;

/// The convex outline of a body seen from above.
/// @param pose of the body in the grid's frame
Outline footprint(const TriangleMesh& mesh, const Eigen::Isometry3d& pose);

/// Writes a PNG of the sand as a shaded relief seen from above, north (the largest y) up and lit from the
/// north-west: sand in sand tones, paler the higher it lies, bare bed grey, outlines as lines, with a scale
/// bar. Where there are grains, sand has the colour of the highest. 1400 pixels on the long side within a
/// border of kPictureBorder pixels.
/// @throws std::runtime_error naming the file if it cannot be written, or for fields that do not fit the grid
void writePicture(const std::string& path, const Grid& grid, const Fields& fields,
                  const std::vector<Outline>& outlines = {}, const GrainCloud& grains = {});

constexpr int kPictureLongSide = 1400;
constexpr int kPictureBorder = 24;

}  // namespace shallow_sand
