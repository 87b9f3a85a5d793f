#pragma once

#include <Eigen/Core>

#include "shallow_sand/core/fields.h"
#include "shallow_sand/core/parameters.h"
#include "shallow_sand/solver/equations.h"

namespace shallow_sand {

/// Rounds checked parameters to what the equations work with.
LocalMaterial localMaterial(const Material& material, const Grid& grid);

/// LocalMaterial of each cell, each member in a list of its own; none where the material is the same
/// everywhere.
struct LocalMaterialFields {
  std::vector<float> repose_rise;
  std::vector<float> layer_fraction;
  std::vector<float> layer_depth;
};
LocalMaterialFields localMaterial(const Material& material, const MaterialFields& fields, const Grid& grid);

/// Rounds checked parameters to what the equations work with; gravity in the grid's frame [m/s²].
SandConstants sandConstants(const Grid& grid, const Eigen::Vector3d& gravity, const Material& material);

}  // namespace shallow_sand
