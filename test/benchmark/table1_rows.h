#pragma once

#include <optional>
#include <string>
#include <vector>

#include "shallow_sand/scene/scene.h"

namespace shallow_sand {

/// A row of the paper's Table 1. What the paper does not tell, the scene and the length of a cell, is ours.
struct Table1Row {
  std::string name;  ///< the paper's figure, and what is in it
  int columns;
  int rows;
  double friction_angle;             ///< θ [degrees]
  double layer_depth;                ///< h̄ [cells]; infinite: the whole depth
  std::optional<double> fixed_step;  ///< Δt [s]; C = 0.1 without one
  double spacing;                    ///< ΔL [m]: with a fixed step so long that waves stay within C = 0.45
  void (*fill)(Scene&);              ///< puts sand and bodies on an empty map
  std::string paper;                 ///< what the paper's GTX 1060 took, a frame
  std::optional<GrainParameters> grains{};  ///< those of the paper
};

/// All rows; where a row of the paper stands for several runs, each of these.
std::vector<Table1Row> table1Rows();

/// The scene of a row.
Scene sceneOf(const Table1Row& row, Backend backend);

/// The same map without bodies, with sand without friction that sloshes, deeper than the layer: every cell
/// moves.
Scene sloshingSandOf(const Table1Row& row, Backend backend);

}  // namespace shallow_sand
