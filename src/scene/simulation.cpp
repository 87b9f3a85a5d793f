#include "shallow_sand/scene/simulation.h"

#include <algorithm>
#include <utility>

#include "shallow_sand/bodies/distance_field.h"
#include "shallow_sand/bodies/motion.h"

namespace shallow_sand {
namespace {

void addBody(Simulator& simulator, const SceneBody& body) {
  const TriangleMesh mesh = triangulate(body.shape);
  const double spacing = distanceSpacing(mesh, simulator.parameters().grid.spacing);
  auto field = std::make_shared<const DistanceField>(computeDistanceField(mesh, spacing));
  const std::size_t number = simulator.addBody(body.name, std::move(field));
  for (const PoseKey& key : body.motion) {
    simulator.appendPose(number, key.time, key.pose);
  }
}

}  // namespace

Simulator buildSimulator(Scene scene) {
  std::string about;
  try {
    Simulator simulator(scene.parameters, std::move(scene.bed), std::move(scene.depth),
                        scene.material_fields);
    for (std::size_t k = 0; k < scene.pours.size(); ++k) {
      about = "pours[" + std::to_string(k) + "].";
      simulator.addPour(scene.pours[k]);
    }
    for (std::size_t k = 0; k < scene.bodies.size(); ++k) {
      about = "bodies[" + std::to_string(k) + "]: ";
      addBody(simulator, scene.bodies[k]);
    }
    return simulator;
  } catch (const InvalidParameter& error) {
    throw SceneError(scene.source + ": " + about + error.what());
  }
}

double distanceSpacing(const TriangleMesh& mesh, double sand_spacing) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    box.extend(vertex);
  }
  const double finest = std::max(box.sizes().minCoeff() / 4.0, sand_spacing / 8.0);
  return std::min(sand_spacing / 2.0, finest);
}

Eigen::Isometry3d poseAt(const SceneBody& body, double time) {
  Motion motion;
  for (const PoseKey& key : body.motion) {
    motion.append(key.time, key.pose);
  }
  return motion.poseAt(time);
}

}  // namespace shallow_sand
