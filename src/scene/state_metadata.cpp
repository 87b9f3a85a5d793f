#include "state_metadata.h"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <stdexcept>

namespace shallow_sand {
namespace {

std::string exact(double value) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%a", value);
  return text.data();
}

std::string edgeName(Edge edge) { return edge == Edge::open ? "open" : "wall"; }

void describeParameters(const SimulatorParameters& parameters, Metadata& metadata) {
  metadata["grid.size_x"] = exact(parameters.grid.size.x());
  metadata["grid.size_y"] = exact(parameters.grid.size.y());
  metadata["grid.spacing"] = exact(parameters.grid.spacing);
  metadata["grid.origin_x"] = exact(parameters.grid.origin.x());
  metadata["grid.origin_y"] = exact(parameters.grid.origin.y());
  metadata["grid.frame"] = parameters.grid.frame;
  metadata["gravity.x"] = exact(parameters.gravity.x());
  metadata["gravity.y"] = exact(parameters.gravity.y());
  metadata["gravity.z"] = exact(parameters.gravity.z());
  metadata["material.friction_angle_rad"] = exact(parameters.material.friction_angle);
  metadata["material.dilute_layer.fraction"] = exact(parameters.material.layer_fraction);
  metadata["material.dilute_layer.depth"] = exact(parameters.material.layer_depth);
  metadata["edges.x_min"] = edgeName(parameters.edges.x_min);
  metadata["edges.x_max"] = edgeName(parameters.edges.x_max);
  metadata["edges.y_min"] = edgeName(parameters.edges.y_min);
  metadata["edges.y_max"] = edgeName(parameters.edges.y_max);
  metadata["solver.reconstruction"] =
      parameters.solver.reconstruction == Reconstruction::minmod ? "minmod" : "constant";
  metadata["solver.courant"] = exact(parameters.solver.courant);
  metadata["solver.max_step"] = exact(parameters.solver.max_step);
  if (parameters.solver.fixed_step) {
    metadata["solver.fixed_step"] = exact(*parameters.solver.fixed_step);
  }
}

void describe(const Snapshot& snapshot, Metadata& metadata) {
  metadata["time"] = exact(snapshot.time);
  metadata["next_step"] = exact(snapshot.next_step);
  metadata["steps"] = std::to_string(snapshot.progress.steps);
  metadata["cell_updates"] = std::to_string(snapshot.progress.cell_updates);
  metadata["repeated_steps"] = std::to_string(snapshot.progress.repeated_steps);
  metadata["last_step"] = exact(snapshot.progress.last_step);
  metadata["ledger.start"] = exact(snapshot.ledger.start);
  metadata["ledger.poured"] = exact(snapshot.ledger.poured);
  metadata["ledger.left"] = exact(snapshot.ledger.left);
  metadata["ledger.now"] = exact(snapshot.ledger.now);
  metadata["bodies_cleared"] = snapshot.bodies_cleared ? "1" : "0";
  std::ostringstream windows;
  windows << snapshot.contacts.windows.size();
  for (const Window& window : snapshot.contacts.windows) {
    windows << " " << window.column_begin << " " << window.row_begin << " " << window.column_end << " "
            << window.row_end;
  }
  metadata["contacts.windows"] = windows.str();
}

const std::string& textOf(const Metadata& metadata, const std::string& key) {
  const auto item = metadata.find(key);
  if (item == metadata.end())
    throw InvalidParameter(key, "missing", "the metadata of a state that sand_run --save wrote");
  return item->second;
}

double numberOf(const Metadata& metadata, const std::string& key) {
  const std::string& text = textOf(metadata, key);
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0') throw InvalidParameter(key, text, "a number");
  return number;
}

/// Not from a double, which would round large counts.
std::uint64_t countOf(const Metadata& metadata, const std::string& key) {
  numberOf(metadata, key);
  return std::strtoull(textOf(metadata, key).c_str(), nullptr, 10);
}

std::vector<Window> windowsOf(const Metadata& metadata, const std::string& key, const Grid& grid) {
  std::vector<Window> windows;
  std::istringstream text(textOf(metadata, key));
  std::size_t count = 0;
  text >> count;
  Window w;
  while (windows.size() < count && text >> w.column_begin >> w.row_begin >> w.column_end >> w.row_end) {
    const bool on_grid = w.column_begin >= 0 && w.row_begin >= 0 && !w.empty() &&
                         w.column_end <= grid.columns && w.row_end <= grid.rows;
    if (!on_grid) break;
    windows.push_back(w);
  }
  if (text.fail() || windows.size() != count)
    throw InvalidParameter(key, textOf(metadata, key), "columns and rows of rectangles on the grid");
  return windows;
}

}  // namespace

Metadata stateMetadata(const SimulatorParameters& parameters, const Snapshot& snapshot) {
  Metadata metadata{{"version", SHALLOW_SAND_VERSION}};
  describeParameters(parameters, metadata);
  describe(snapshot, metadata);
  return metadata;
}

void requireSameGrid(const Metadata& metadata, const SimulatorParameters& parameters) {
  Metadata expected;
  describeParameters(parameters, expected);
  for (const auto& item : expected) {
    if (item.first.rfind("grid.", 0) != 0 || item.first == "grid.frame") continue;
    const double found = numberOf(metadata, item.first);
    const double wanted = numberOf(expected, item.first);
    if (found != wanted)
      throw InvalidParameter(item.first, std::to_string(found),
                             std::to_string(wanted) + " as the scene has it");
  }
}

Snapshot snapshotOf(const Metadata& metadata, const Grid& grid) {
  Snapshot snapshot;
  snapshot.time = numberOf(metadata, "time");
  snapshot.next_step = numberOf(metadata, "next_step");
  snapshot.progress.steps = countOf(metadata, "steps");
  snapshot.progress.cell_updates = countOf(metadata, "cell_updates");
  snapshot.progress.repeated_steps = countOf(metadata, "repeated_steps");
  snapshot.progress.last_step = numberOf(metadata, "last_step");
  snapshot.ledger = {numberOf(metadata, "ledger.start"), numberOf(metadata, "ledger.poured"),
                     numberOf(metadata, "ledger.left"), numberOf(metadata, "ledger.now")};
  snapshot.bodies_cleared = numberOf(metadata, "bodies_cleared") != 0.0;
  snapshot.contacts.windows = windowsOf(metadata, "contacts.windows", grid);
  return snapshot;
}

}  // namespace shallow_sand
