#pragma once

#include <string>
#include <vector>

#include "shallow_sand/scene/scene.h"
#include "shallow_sand/sim/simulator.h"

namespace shallow_sand {

/// A simulator with the sand, pours and bodies of `scene`, at time 0. Distance fields of meshes are kept in
/// defaultCacheFolder().
/// @param notes if given, gets a line for all that a user should know about the bodies
/// @throws SceneError, also if the backend that the scene asks for is not there
Simulator buildSimulator(Scene scene, std::vector<std::string>* notes = nullptr);

/// What a simulator of the scene begins with: its sand at rest, at time 0.
Snapshot startOf(const Scene& scene);

/// Where a body of a scene is at a time [s], in the grid's frame.
Eigen::Isometry3d poseAt(const SceneBody& body, double time);

}  // namespace shallow_sand
