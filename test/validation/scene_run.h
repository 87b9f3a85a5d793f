#pragma once

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <string>
#include <utility>

#include "lagrangian_sand.h"
#include "profile.h"
#include "scheme.h"
#include "shallow_sand/scene/scene.h"
#include "shallow_sand/scene/simulation.h"

namespace shallow_sand {

/// A scene of config/scenes/validation as YAML, for a test to change keys of.
inline YAML::Node sceneFile(const std::string& name) {
  return YAML::LoadFile(SHALLOW_SAND_SOURCE_DIR "/config/scenes/validation/" + name + ".yaml");
}

/// The same for a channel along x, three cells wide whatever the spacing.
inline YAML::Node channelFile(const std::string& name, double spacing) {
  YAML::Node file = sceneFile(name);
  file["grid"]["spacing"] = spacing;
  file["grid"]["size"][1] = 3.0 * spacing;
  for (YAML::Node layer : file["sand"]) {
    if (layer["box"]) layer["box"]["max"][1] = 3.0 * spacing;
  }
  return file;
}

/// A simulator of that scene, on one thread of the CPU.
inline Simulator simulatorOf(const YAML::Node& file, const Scheme& scheme) {
  Scene scene = readScene(file, "validation");
  scene.parameters.backend = Backend::cpu;
  scene.parameters.threads = 1;
  scene.parameters.solver = scheme.parameters();
  return buildSimulator(std::move(scene));
}

/// Runs until no sand moves; a failure if that takes until `latest` [s]. Calls `see()` every hundredth of a
/// second.
template <class See>
void runToRest(Simulator& simulator, double latest, const See& see) {
  do {
    simulator.advance(0.01);
    see();
    ASSERT_LT(simulator.time(), latest) << simulator.activeCells() << " cells still move";
  } while (simulator.activeCells() > 0);
}
inline void runToRest(Simulator& simulator, double latest) {
  runToRest(simulator, latest, [] {});
}

/// Depth along the row of cells with the smallest y.
inline Profile profileOf(const Simulator& simulator) {
  const Fields fields = simulator.fields();
  Profile profile;
  for (int i = 0; i < simulator.grid().columns; ++i) {
    profile.x.push_back(simulator.grid().x(i));
    profile.depth.push_back(fields.depth[simulator.grid().index(i, 0)]);
  }
  return profile;
}

/// What a scene of a flow along x tells, for the reference solver.
inline LagrangianLaw lawOf(const YAML::Node& file) {
  const Scene scene = readScene(file, "validation");
  const SimulatorParameters& parameters = scene.parameters;
  LagrangianLaw law;
  law.friction = std::tan(parameters.material.friction_angle);
  law.gravity = -parameters.gravity.z();
  law.slope = (scene.bed[0] - scene.bed[1]) / parameters.grid.spacing;
  law.layer_fraction = parameters.material.layer_fraction;
  law.layer_depth = parameters.material.layer_depth;
  return law;
}

/// ∫|h − h_reference| dx / ∫h_reference dx, at the samples of `ours`, evenly spaced.
inline double relativeDifference(const Profile& ours, const Profile& reference) {
  double error = 0.0;
  double total = 0.0;
  for (std::size_t k = 0; k < ours.x.size(); ++k) {
    const double h = reference.at(ours.x[k]);
    error += std::abs(ours.depth[k] - h);
    total += h;
  }
  return error / total;
}

}  // namespace shallow_sand
