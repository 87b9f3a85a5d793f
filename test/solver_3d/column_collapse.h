#pragma once

#include <vector>

#include "shallow_sand/scene/scene.h"
#include "solver_3d/material_points.h"
#include "validation/profile.h"

/// The paper's figure 15: a column of sand collapses on a height field and in three dimensions.
namespace shallow_sand {

/// A column of sand on the map of config/scenes/tall_column.yaml.
struct Column {
  double height = 0.8;            ///< [m]
  double layer = 0.2;             ///< depth of the dilute layer [m]
  double spacing = 0.02;          ///< of both grids [m]; a whole number of cells must fit
  double youngs_modulus = 3.5e5;  ///< of the sand in three dimensions [Pa]

  /// The scene file with these, on the CPU, without grains.
  Scene scene(int threads) const;
  /// The same column in a cube of as many cells; the sand is that of the scene's cells.
  MaterialPoints points(int threads) const;
};

/// Depth around the middle of the map: means over rings of cells, each a cell wide, as far as they are
/// whole.
/// @param depth of all cells, laid out as in Fields [m]
Profile radialProfile(const Grid& grid, const std::vector<double>& depth);
Profile radialProfile(const Simulator& simulator);

/// ∫|h − h_reference| dA / ∫h_reference dA over the rings.
double relativeDeviation(const Profile& profile, const Profile& reference);

}  // namespace shallow_sand
