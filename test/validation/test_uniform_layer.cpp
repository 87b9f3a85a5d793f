#include <gtest/gtest.h>

#include "figures.h"
#include "scene_run.h"
#include "shallow_sand/solver/equations.h"
#include "shallow_sand/solver/sand_constants.h"

namespace shallow_sand {
namespace {

/// A layer of sand, as deep everywhere, on a plane steeper than friction holds. Its upper end is a wall, its
/// lower end is open.
struct Layer {
  double inclination;     ///< [°]
  double friction_angle;  ///< [°]
  double depth;           ///< [m]
  double layer_depth;     ///< of the layer that flows [m]
  bool tilted;            ///< gravity is tilted, in place of the bed

  double friction() const { return std::tan(friction_angle * M_PI / 180.0); }
  double slope() const { return std::tan(inclination * M_PI / 180.0); }
  /// Acceleration of sand that the wall does not feel: the layer's weight less its friction moves the whole
  /// column. In the grid's plane, whose measure of length a sloping bed leaves horizontal. [m/s²]
  double acceleration() const {
    const double g = tilted ? 9.81 * std::cos(inclination * M_PI / 180.0) : 9.81;
    return g * (slope() - friction()) * std::min(layer_depth, depth) / depth;
  }
};

/// Speed of the sand. [m/s]
struct Speed {
  double middle;   ///< of the plane, which neither end reaches
  double at_edge;  ///< in the last cell before the open end
};

Speed speedAfter(const Layer& layer, const Scheme& scheme, double time) {
  SimulatorParameters parameters;
  parameters.backend = Backend::cpu;
  parameters.threads = 1;
  parameters.solver = scheme.parameters();
  parameters.grid.spacing = 0.02;
  parameters.grid.size = {2.0, 0.06};
  parameters.material.friction_angle = layer.friction_angle * M_PI / 180.0;
  parameters.material.layer_depth = layer.layer_depth;
  parameters.edges.x_max = Edge::open;
  if (layer.tilted) {
    const double angle = layer.inclination * M_PI / 180.0;
    parameters.gravity = {9.81 * std::sin(angle), 0.0, -9.81 * std::cos(angle)};
  }
  const Grid grid = parameters.grid.grid();
  std::vector<float> bed(grid.cells());
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      bed[grid.index(i, j)] = layer.tilted ? 0.0f : static_cast<float>(-layer.slope() * grid.x(i));
    }
  }
  Simulator simulator(parameters, bed, std::vector<float>(grid.cells(), static_cast<float>(layer.depth)));
  simulator.advance(time);
  const Fields fields = simulator.fields();
  const auto speed = [&](int column) {
    const std::size_t k = grid.index(column, 1);
    return static_cast<double>(fields.momentum_x[k] / fields.depth[k]);
  };
  return {speed(grid.columns / 2), speed(grid.columns - 1)};
}

/// Where nothing but friction acts, which Eq. 19 alone describes.
struct Slide {
  double time = 0.0;  ///< until it rests [s]
  double way = 0.0;   ///< [m]
};

Slide slideToRest(double speed, double depth, double step, const LocalMaterial& material,
                  const SandConstants& sand) {
  const float h = static_cast<float>(depth);
  Momentum q{h * static_cast<float>(speed), 0.0f};
  Slide slide;
  while (q.x > 0.0f) {
    const float before = q.x;
    q = applyFriction(q, {q.x / static_cast<float>(step), 0.0f}, diluteLayer(h, material),
                      material.repose_rise, sand);
    slide.time += step;
    slide.way += 0.5 * static_cast<double>((before + q.x) / h) * step;
  }
  return slide;
}

class UniformLayer : public ::testing::Test {
 protected:
  static FigureLog& log() {
    static FigureLog log("uniform_layer");
    return log;
  }
};

/// Coulomb's law: u = u₀ − μ g t, until u₀/(μ g), over u₀²/(2 μ g); h̄/h of it where only a layer rubs.
TEST_F(UniformLayer, StopsByFrictionAlone) {
  const double speed = 1.0;
  const double depth = 0.1;
  const double step = 1e-4;
  for (const double layer_depth : {std::numeric_limits<double>::infinity(), 0.04}) {
    const Grid grid = GridParameters().grid();
    Material material;
    material.friction_angle = 30.9 * M_PI / 180.0;
    material.layer_depth = layer_depth;
    const Slide slide = slideToRest(speed, depth, step, localMaterial(material, grid),
                                    sandConstants(grid, {0.0, 0.0, -9.81}, material));
    const double braking = std::tan(material.friction_angle) * 9.81 * std::min(layer_depth, depth) / depth;
    const std::string name = std::string("layer at 1 m/s on a plain, ") +
                             (layer_depth < depth ? "0.4 of it rubs" : "all of it rubs");
    log().near({kSchemes[0], name, "time to rest", "s", speed / braking, slide.time}, 2.0 * step,
               "two time steps");
    log().near({kSchemes[0], name, "way to rest", "m", speed * speed / (2.0 * braking), slide.way},
               2.0 * step * speed, "two time steps at full speed");
  }
}

TEST_F(UniformLayer, AcceleratesByItsWeightLessItsFriction) {
  const double time = 0.3;
  const double whole = std::numeric_limits<double>::infinity();
  for (const Layer& layer : {Layer{35.0, 23.0, 0.1, whole, false}, Layer{35.0, 23.0, 0.1, whole, true},
                             Layer{35.0, 23.0, 0.1, 0.04, false}, Layer{35.0, 23.0, 0.1, 0.04, true}}) {
    const double expected = layer.acceleration() * time;
    const std::string name = std::string("uniform layer, ") +
                             (layer.tilted ? "tilted gravity" : "sloping bed") +
                             (layer.layer_depth < layer.depth ? ", 0.4 of it flows" : ", all of it flows");
    for (const Scheme& scheme : kSchemes) {
      const Speed speed = speedAfter(layer, scheme, time);
      log().near({scheme, name, "speed after 0.3 s", "m/s", expected, speed.middle}, 1e-3 * expected,
                 "0.1 %, for single precision");
      log().tell({scheme, name, "the same before the open edge", "m/s", expected, speed.at_edge});
    }
  }
}

}  // namespace
}  // namespace shallow_sand
