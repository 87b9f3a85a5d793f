#include "shallow_sand/scene/scene.h"

#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <fstream>

#include "bounds.h"
#include "scene_reader.h"
#include "scene_value.h"

namespace shallow_sand {

const std::vector<std::string>& sceneKeys() {
  static const std::vector<std::string> keys{"grid",     "gravity", "material", "edges",  "bed",
                                             "sand",     "pours",   "bodies",   "solver", "grains",
                                             "duration", "backend", "threads"};
  return keys;
}

Scene loadScene(const std::string& path) {
  std::ifstream file(path);
  if (!file || std::filesystem::is_directory(path)) {
    throw SceneError(path + ": cannot be read; expected a scene file");
  }
  try {
    const std::string folder = std::filesystem::path(path).parent_path().string();
    Scene scene = readScene(YAML::Load(file), path, folder.empty() ? "." : folder);
    scene.name = std::filesystem::path(path).stem().string();
    return scene;
  } catch (const YAML::Exception& error) {
    const std::string line = error.mark.is_null() ? "" : ":" + std::to_string(error.mark.line + 1);
    throw SceneError(path + line + ": not valid YAML (" + error.msg + "); expected a scene");
  }
}

Scene readScene(const YAML::Node& root_node, const std::string& source_name, const std::string& folder) {
  const SceneValue root(root_node, {source_name, folder});
  root.requireMap(sceneKeys());
  Scene scene;
  scene.source = source_name;
  scene.name = source_name;
  scene.parameters = readParameters(root);
  root.read("duration", bounds::not_negative, scene.duration);
  scene.pours = readPours(root);
  scene.bodies = readBodies(root);
  const Grid grid = scene.parameters.grid.grid();
  scene.material_fields = readMaterialFields(root, grid);
  scene.bed = readBed(root, grid);
  scene.depth = readSand(root, grid, scene.bed);
  return scene;
}

}  // namespace shallow_sand
