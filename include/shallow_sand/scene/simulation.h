#pragma once

#include "shallow_sand/scene/scene.h"
#include "shallow_sand/sim/simulator.h"

namespace shallow_sand {

/// A simulator with the sand, pours and bodies of `scene`, at time 0.
/// @throws SceneError, also if the backend that the scene asks for is not there
Simulator buildSimulator(Scene scene);

/// Distance between samples [m] of a body's distance field on sand of `sand_spacing` [m]: half of a cell,
/// less for bodies thinner than two cells, but not below an eighth of a cell.
double distanceSpacing(const TriangleMesh& mesh, double sand_spacing);

/// Where a body of a scene is at a time [s], in the grid's frame.
Eigen::Isometry3d poseAt(const SceneBody& body, double time);

}  // namespace shallow_sand
