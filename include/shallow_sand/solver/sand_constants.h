#pragma once

#include <Eigen/Core>

#include "shallow_sand/core/parameters.h"
#include "shallow_sand/solver/equations.h"

namespace shallow_sand {

/// Rounds checked parameters to what the equations work with; gravity in the grid's frame [m/s²].
SandConstants sandConstants(const Grid& grid, const Eigen::Vector3d& gravity, const Material& material);

}  // namespace shallow_sand
