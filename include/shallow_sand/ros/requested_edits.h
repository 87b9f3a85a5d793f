#pragma once

#include <Eigen/Geometry>

#include "shallow_sand/EditSand.h"
#include "shallow_sand/PourSand.h"
#include "shallow_sand/core/grid.h"
#include "shallow_sand/core/parameters.h"

namespace shallow_sand {

/// The edit that a request asks for. @param frame pose of its frame in the sand's
/// @throws InvalidParameter naming the field of the request
Edit requestedEdit(const EditSand::Request& request, const Eigen::Isometry3d& frame);

/// The same for a message of ~pour, whose volume falls on the cells that its disc covers.
Edit requestedEdit(const PourSand& message, const Eigen::Isometry3d& frame, const Grid& grid);

}  // namespace shallow_sand
