#include "bounds.h"
#include "scene_reader.h"

namespace shallow_sand {
namespace {

GridParameters readGrid(const SceneValue& grid) {
  grid.requireMap({"size", "spacing", "origin", "frame"});
  GridParameters parameters;
  grid.read("size", bounds::positive, parameters.size);
  grid.read("spacing", bounds::positive, parameters.spacing);
  grid.read("origin", bounds::finite, parameters.origin);
  grid.read("frame", parameters.frame);
  return parameters;
}

void readEdge(const SceneValue& edges, const std::string& side, Edge& edge) {
  if (const auto value = edges.find(side)) {
    const std::string kind = value->text();
    if (kind != "wall" && kind != "open") {
      value->fail("wall or open");
    }
    edge = kind == "open" ? Edge::open : Edge::wall;
  }
}

Edges readEdges(const SceneValue& value) {
  value.requireMap({"x_min", "x_max", "y_min", "y_max"});
  Edges edges;
  readEdge(value, "x_min", edges.x_min);
  readEdge(value, "x_max", edges.x_max);
  readEdge(value, "y_min", edges.y_min);
  readEdge(value, "y_max", edges.y_max);
  return edges;
}

SolverParameters readSolver(const SceneValue& solver) {
  solver.requireMap({"reconstruction", "courant", "max_step", "fixed_step", "coupling"});
  SolverParameters parameters;
  if (const auto reconstruction = solver.find("reconstruction")) {
    const std::string name = reconstruction->text();
    if (name != "constant" && name != "minmod") reconstruction->fail("constant or minmod");
    if (name == "minmod") {
      parameters.reconstruction = Reconstruction::minmod;
      parameters.courant = kCourantOfMinmod;
    }
  }
  solver.read("courant", bounds::finite, parameters.courant);
  solver.read("max_step", bounds::finite, parameters.max_step);
  if (const auto step = solver.find("fixed_step")) {
    parameters.fixed_step = step->number(bounds::finite);
  }
  return parameters;
}

Coupling readCoupling(const SceneValue& value) {
  const std::string name = value.text();
  if (name == "displacement") return Coupling::displacement;
  if (name == "drag") return Coupling::drag;
  if (name != "horizontal_drag") value.fail("displacement, drag or horizontal_drag");
  return Coupling::horizontal_drag;
}

/// One of two words.
bool isFirst(const SceneValue& value, const std::string& first, const std::string& second) {
  const std::string word = value.text();
  if (word != first && word != second) value.fail(first + " or " + second);
  return word == first;
}

GrainParameters readGrains(const SceneValue& grains) {
  grains.requireMap({"per_cell", "layers", "speed", "color"});
  GrainParameters parameters;
  const auto read = [&](const char* key, int& target) {
    if (const auto value = grains.find(key)) target = static_cast<int>(value->number(bounds::count));
  };
  read("per_cell", parameters.per_cell);
  read("layers", parameters.layers);
  if (const auto speed = grains.find("speed"))
    parameters.speed = isFirst(*speed, "mean", "dilute") ? GrainSpeed::mean : GrainSpeed::dilute;
  if (const auto color = grains.find("color"))
    parameters.color = isFirst(*color, "origin", "layer") ? GrainColor::origin : GrainColor::layer;
  return parameters;
}

}  // namespace

SimulatorParameters readParameters(const SceneValue& root) {
  SimulatorParameters parameters;
  if (const auto grid = root.find("grid")) {
    parameters.grid = readGrid(*grid);
  }
  if (const auto gravity = root.find("gravity")) {
    parameters.gravity = gravity->vector<3>(bounds::finite);
  }
  if (const auto material = root.find("material")) {
    parameters.material = readMaterial(*material);
  }
  if (const auto edges = root.find("edges")) {
    parameters.edges = readEdges(*edges);
  }
  if (const auto solver = root.find("solver")) {
    parameters.solver = readSolver(*solver);
    if (const auto coupling = solver->find("coupling")) parameters.coupling = readCoupling(*coupling);
  }
  if (const auto grains = root.find("grains")) {
    parameters.grains = readGrains(*grains);
  }
  if (const auto backend = root.find("backend")) {
    root.check([&] { parameters.backend = backendFromString(backend->text()); });
  }
  if (const auto threads = root.find("threads")) {
    parameters.threads = static_cast<int>(threads->number(bounds::thread_count));
  }
  root.check([&] { parameters.validate(); });
  return parameters;
}

}  // namespace shallow_sand
