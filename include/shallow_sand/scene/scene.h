#pragma once

#include <Eigen/Geometry>
#include <stdexcept>
#include <string>
#include <vector>

#include "shallow_sand/bodies/body_geometry.h"
#include "shallow_sand/bodies/shape.h"
#include "shallow_sand/core/one_line.h"
#include "shallow_sand/core/parameters.h"
#include "shallow_sand/sim/simulator.h"

namespace YAML {
class Node;
}

namespace shallow_sand {

/// A scene that cannot be used. what() is one line, "FILE:LINE: KEY: FOUND; expected EXPECTED"; the line
/// number is left out where it is not known.
class SceneError : public std::runtime_error {
 public:
  explicit SceneError(const std::string& message) : std::runtime_error(oneLine(message)) {}
};

/// Where a body is at one time.
struct PoseKey {
  double time = 0.0;                                       ///< [s]
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< of the body in the grid's frame
};

/// A kinematic body. Scene key `bodies`.
struct SceneBody {
  std::string name;                         ///< unlike that of any other body
  Shape shape;                              ///< in the body's frame
  LinkShape stands_for = LinkShape::exact;  ///< what of a mesh goes into the sand
  std::string mesh_uri;                     ///< where the mesh came from; empty for other shapes
  Eigen::Vector3d mesh_scale = Eigen::Vector3d::Ones();
  std::vector<PoseKey> motion;  ///< at least one; times increase
};

/// Everything that a scene file says.
struct Scene {
  std::string source;  ///< the file, or what stands for it in errors
  std::string name;    ///< the file's name without folder and extension
  SimulatorParameters parameters;
  std::vector<float> bed;    ///< elevation, laid out as in Fields [m]
  std::vector<float> depth;  ///< of the sand, laid out as in Fields; not negative [m]
  MaterialFields material_fields;
  std::vector<Pour> pours;
  std::vector<SceneBody> bodies;
  double duration = 10.0;  ///< [s], not negative
};

/// The keys that a scene may have.
const std::vector<std::string>& sceneKeys();

/// Reads a scene file. @throws SceneError
Scene loadScene(const std::string& path);

/// Reads a scene from a map with the same keys, from wherever it comes.
/// @param source_name stands for the file in errors, and is the scene's name too
/// @param folder that paths in the scene start from; empty: they must be absolute
/// @throws SceneError
Scene readScene(const YAML::Node& root, const std::string& source_name, const std::string& folder = "");

}  // namespace shallow_sand
