#include "shallow_sand/scene/simulation.h"

#include <limits>
#include <numeric>
#include <utility>
#include <variant>

#include "shallow_sand/bodies/body_geometry.h"
#include "shallow_sand/bodies/motion.h"

namespace shallow_sand {
namespace {

void addBody(Simulator& simulator, const SceneBody& body, std::vector<std::string>* notes) {
  BodyGeometryOptions options;
  options.shape = body.stands_for;
  // The other shapes are sampled sooner than a file is read.
  if (std::holds_alternative<TriangleMesh>(body.shape)) options.cache = defaultCacheFolder();
  const BodyGeometry geometry =
      makeBodyGeometry(triangulate(body.shape), simulator.parameters().grid.spacing, options);
  if (notes != nullptr) {
    for (const std::string& note : geometry.notes) notes->push_back("body " + body.name + ": " + note);
  }
  const std::size_t number = simulator.addBody(body.name, geometry.field);
  for (const PoseKey& key : body.motion) {
    simulator.appendPose(number, key.time, key.pose);
  }
}

}  // namespace

Simulator buildSimulator(Scene scene, std::vector<std::string>* notes) {
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
      addBody(simulator, scene.bodies[k], notes);
    }
    return simulator;
  } catch (const InvalidParameter& error) {
    throw SceneError(scene.source + ": " + about + error.what());
  }
}

Snapshot startOf(const Scene& scene) {
  Snapshot start;
  const std::vector<float> rest(scene.depth.size(), 0.0f);
  start.fields.bed = scene.bed;
  start.fields.depth = scene.depth;
  start.fields.momentum_x = rest;
  start.fields.momentum_y = rest;
  start.next_step = std::numeric_limits<double>::infinity();
  const double depths = std::accumulate(scene.depth.begin(), scene.depth.end(), 0.0);
  start.ledger.start = depths * scene.parameters.grid.grid().cellArea();
  return start;
}

Eigen::Isometry3d poseAt(const SceneBody& body, double time) {
  Motion motion;
  for (const PoseKey& key : body.motion) {
    motion.append(key.time, key.pose);
  }
  return motion.poseAt(time);
}

}  // namespace shallow_sand
