#include <gtest/gtest.h>

#include "figures.h"
#include "scene_run.h"

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

/// Speed of the sand before the open end. [m/s]
double speedAfter(const Layer& layer, double time) {
  SimulatorParameters parameters;
  parameters.backend = Backend::cpu;
  parameters.threads = 1;
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
  const std::size_t k = grid.index(grid.columns - 10, 1);
  return fields.momentum_x[k] / fields.depth[k];
}

TEST(UniformLayer, AcceleratesByItsWeightLessItsFriction) {
  FigureLog log("uniform_layer");
  const double time = 0.3;
  const double whole = std::numeric_limits<double>::infinity();
  for (const Layer& layer : {Layer{35.0, 23.0, 0.1, whole, false}, Layer{35.0, 23.0, 0.1, whole, true},
                             Layer{35.0, 23.0, 0.1, 0.04, false}, Layer{35.0, 23.0, 0.1, 0.04, true}}) {
    const double expected = layer.acceleration() * time;
    const std::string name = std::string("uniform layer, ") +
                             (layer.tilted ? "tilted gravity" : "sloping bed") +
                             (layer.layer_depth < layer.depth ? ", 0.4 of it flows" : ", all of it flows");
    log.near({name, "speed after 0.3 s", "m/s", expected, speedAfter(layer, time)}, 1e-3 * expected,
             "0.1 %: roundings of single precision");
  }
}

}  // namespace
}  // namespace shallow_sand
