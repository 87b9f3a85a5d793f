#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "shallow_sand/QuerySurface.h"
#include "shallow_sand/VolumeInPolygon.h"
#include "shallow_sand/core/fields.h"
#include "shallow_sand/core/grid.h"

namespace shallow_sand {

/// @throws InvalidParameter for too many points, or one that is no place
void requirePoints(const QuerySurface::Request& request);

/// What ~query_surface answers to points that were required. @param frame pose of their frame in the sand's
QuerySurface::Response surfaceAt(const QuerySurface::Request& request, const Eigen::Isometry3d& frame,
                                 const Grid& grid, const Fields& fields);

/// The corners of a simple polygon, seen along the vertical of the sand's frame, in which they are.
/// @throws InvalidParameter if it is not simple
std::vector<Eigen::Vector2d> requestedPolygon(const VolumeInPolygon::Request& request,
                                              const Eigen::Isometry3d& frame);

}  // namespace shallow_sand
