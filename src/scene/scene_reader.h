#pragma once

#include <vector>

#include "scene_value.h"
#include "shallow_sand/scene/scene.h"

namespace shallow_sand {

/// The parts of readScene, each from the whole scene's map; all throw SceneError.
SimulatorParameters readParameters(const SceneValue& root);
MaterialFields readMaterialFields(const SceneValue& root, const Grid& grid);
std::vector<Pour> readPours(const SceneValue& root);
std::vector<SceneBody> readBodies(const SceneValue& root);
/// Elevation of the bed at every cell. [m]
std::vector<float> readBed(const SceneValue& root, const Grid& grid);
/// Depth of the sand at every cell. [m]
std::vector<float> readSand(const SceneValue& root, const Grid& grid, const std::vector<float>& bed);

/// The scene key `material`, but for what files give.
Material readMaterial(const SceneValue& material);

/// One number for each cell, from a map with the key `file` and those that go with it.
/// @param more_keys that the map may have besides
std::vector<float> readTerrain(const SceneValue& map, const Grid& grid,
                               const std::vector<std::string>& more_keys = {});

}  // namespace shallow_sand
