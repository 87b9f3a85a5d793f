#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "shallow_sand/coupling/given_momentum.h"
#include "shallow_sand/particles/grain_memory.h"
#include "shallow_sand/sim/engine.h"
#include "shallow_sand/solver/change_sand.h"

namespace shallow_sand {

/// The grains that an engine starts with, if there are some.
template <template <class> class Memory>
std::optional<GrainMemory<Memory>> grainMemoryOf(const EngineStart& start) {
  if (!start.grains) return std::nullopt;
  const GrainGrid grains(*start.grains, start.grid);
  return GrainMemory<Memory>(*start.grains, start.grid, startingGrains(grains, start.grid, start.fields));
}

/// The sand of a grid, and what bodies and pours have to do with it, on the memory of a backend.
template <template <class> class Memory>
class SandMemory {
 public:
  struct State {
    explicit State(std::size_t cells) : depth(cells), momentum_x(cells), momentum_y(cells) {}
    State(Memory<float> h, Memory<float> hu, Memory<float> hv)
        : depth(std::move(h)), momentum_x(std::move(hu)), momentum_y(std::move(hv)) {}
    SandLayer layer() { return {depth.data(), momentum_x.data(), momentum_y.data()}; }
    Memory<float> depth;
    Memory<float> momentum_x;
    Memory<float> momentum_y;
  };

  /// What bodies need a value a cell for.
  struct Contacts {
    explicit Contacts(const Memory<float>& bed)
        : clearance(bed.size(), std::numeric_limits<float>::infinity()),
          top(bed.size()),
          headroom(bed.size(), std::numeric_limits<float>::infinity()),
          length(bed.size()),
          velocity_x(bed.size()),
          velocity_y(bed.size()),
          velocity_z(bed.size()),
          body(bed.size(), -1),
          swept(bed.size()),
          hidden(bed.size()),
          next_hidden(bed.size()),
          pushed(bed.size()),
          visible_bed(uploaded(downloaded(bed))),
          ceiling(bed.size(), std::numeric_limits<float>::infinity()),
          cover(bed.size(), Cover::none),
          flowed(bed.size()),
          distance(bed.size()) {}
    Memory<float> clearance;
    Memory<float> top;
    Memory<float> headroom;
    Memory<float> length;
    Memory<float> velocity_x;
    Memory<float> velocity_y;
    Memory<float> velocity_z;
    Memory<int> body;
    Memory<std::uint8_t> swept;
    State hidden;
    State next_hidden;
    State pushed;
    Memory<float> visible_bed;
    Memory<float> ceiling;
    Memory<Cover> cover;
    Memory<std::uint8_t> flowed;
    Memory<int> distance;
  };

  struct PourOnBackend {
    ChangeSand change;
    std::size_t covered;  ///< cells
    Memory<double> taken;
    PourTimes times;
  };

  explicit SandMemory(const EngineStart& start)
      : grid(start.grid),
        sand(start.sand),
        open(start.open),
        bed(uploaded(start.fields.bed)),
        state(uploadedState(start.fields)),
        next(uploadedState(start.fields)),
        repose_rise(uploaded(start.material.repose_rise)),
        layer_fraction(uploaded(start.material.layer_fraction)),
        layer_depth(uploaded(start.material.layer_depth)),
        left_over_edges(2 * static_cast<std::size_t>(grid.columns + grid.rows), 0.0) {}

  /// @param material lists as long as those at the start
  void setSand(const SandConstants& constants, const LocalMaterialFields& material) {
    sand = constants;
    set(repose_rise, material.repose_rise);
    set(layer_fraction, material.layer_fraction);
    set(layer_depth, material.layer_depth);
  }

  void addBody(const DistanceField& field) {
    Memory<float> distance = uploaded(field.distance);
    Memory<double> none(rowSums());
    if (contacts.empty()) contacts.emplace_back(bed);
    distance_fields.push_back(std::move(distance));
    given_.push_back(std::move(none));
  }
  void removeBody(std::size_t body) {
    distance_fields[body] = Memory<float>(0);
    given_[body] = Memory<double>(0);
  }

  /// See AddGiven.
  std::vector<double*> givenSums() {
    std::vector<double*> sums;
    for (Memory<double>& given : given_) sums.push_back(given.size() > 0 ? given.data() : nullptr);
    return sums;
  }
  /// By each body that there ever was; 0 by those that were removed. [m⁴/s]
  std::vector<Eigen::Vector2d> givenMomentum() const {
    std::vector<Eigen::Vector2d> momentum;
    for (const Memory<double>& given : given_) {
      momentum.emplace_back(0.0, 0.0);
      const std::vector<double> rows = downloaded(given);
      for (std::size_t k = 0; k < rows.size(); k += 2)
        momentum.back() += grid.cellArea() * Eigen::Vector2d(rows[k], rows[k + 1]);
    }
    return momentum;
  }

  void addPour(const LocalRegion& region, const PourTimes& times) {
    PourOnBackend pour{changeOf(region), 0, Memory<double>(0), times};
    const Window& window = pour.change.window;
    for (int j = window.row_begin; j < window.row_end; ++j) {
      for (int i = window.column_begin; i < window.column_end; ++i)
        pour.covered += pour.change.covers(i, j) ? 1 : 0;
    }
    pour.taken = Memory<double>(window.cells(), 0.0);
    pours.push_back(std::move(pour));
  }

  /// A change without operation, value and memory.
  ChangeSand changeOf(const LocalRegion& region) const {
    ChangeSand change{};
    change.columns = grid.columns;
    change.spacing = grid.spacing;
    change.region = region;
    change.window = windowOf(region, grid);
    return change;
  }
  /// A change of the present state.
  void bind(ChangeSand& change, Memory<double>& taken) {
    change.depth = state.depth.data();
    change.momentum_x = state.momentum_x.data();
    change.momentum_y = state.momentum_y.data();
    change.bed = visibleBed();
    change.hanging = {};
    if (!contacts.empty()) {
      const SandLayer loads = columns().hidden;
      change.hanging = {loads.depth,   loads.momentum_x,  loads.momentum_y,
                        contact().top, columns().ceiling, columns().cover};
    }
    change.taken = taken.data();
  }
  /// Counts what an edit took or gave. Returns by how much the sand grew. [m³]
  double book(const Memory<double>& taken) {
    double grown = 0.0;
    for (const double depth : downloaded(taken)) {
      grown += depth;
      (depth > 0.0 ? edited_in_ : edited_out_) += std::abs(depth);
    }
    return grown * grid.cellArea();
  }
  double poured() const {
    double depth = edited_in_;
    for (const PourOnBackend& p : pours) depth += std::max(sum(p.taken), 0.0);
    return depth * grid.cellArea();
  }
  double left() const {
    double depth = sum(left_over_edges) + edited_out_;
    for (const PourOnBackend& p : pours) depth += std::max(-sum(p.taken), 0.0);
    return depth * grid.cellArea();
  }

  /// Whether pours may bring sand to a window.
  bool isPouredOn(const Window& window) const {
    return std::any_of(pours.begin(), pours.end(), [&](const PourOnBackend& pour) {
      return !window.overlap(pour.change.window).empty();
    });
  }

  ContactSnapshot snapshot(const std::vector<Window>& windows) const {
    ContactSnapshot snapshot;
    snapshot.windows = windows;
    if (windows.empty()) return snapshot;
    const Contacts& c = contacts.front();
    snapshot.clearance = downloaded(c.clearance);
    snapshot.headroom = downloaded(c.headroom);
    snapshot.length = downloaded(c.length);
    snapshot.velocity_x = downloaded(c.velocity_x);
    snapshot.velocity_y = downloaded(c.velocity_y);
    snapshot.velocity_z = downloaded(c.velocity_z);
    for (const Cover cover : downloaded(c.cover)) snapshot.cover.push_back(static_cast<float>(cover));
    return snapshot;
  }

  void restore(const Fields& fields, const ContactSnapshot& snapshot) {
    set(bed, fields.bed);
    std::vector<Cover> cover;
    for (const float value : snapshot.cover) cover.push_back(static_cast<Cover>(static_cast<int>(value)));
    Fields layers = fields;
    if (!snapshot.windows.empty()) swapWhereTouching(cover, layers);
    for (State* layer : {&state, &next}) set(*layer, layers.depth, layers.momentum_x, layers.momentum_y);
    if (contacts.empty()) return;
    for (Memory<double>& given : given_) set(given, std::vector<double>(given.size()));
    // Given back first: there may not be room for both.
    contacts.clear();
    contacts.emplace_back(bed);
    if (!snapshot.windows.empty()) restoreContacts(layers, snapshot, cover);
  }

  /// For memory that the host can read.
  SandView view() const {
    SandView view{state.depth.data(),
                  state.momentum_x.data(),
                  state.momentum_y.data(),
                  nullptr,
                  nullptr,
                  nullptr,
                  nullptr};
    if (contacts.empty()) return view;
    const Contacts& c = contacts.front();
    view.load = c.hidden.depth.data();
    view.load_momentum_x = c.hidden.momentum_x.data();
    view.load_momentum_y = c.hidden.momentum_y.data();
    view.cover = c.cover.data();
    return view;
  }

  /// Brings the cells of a window up to date in fields that were taken before. On the host.
  void download(const Window& window, Fields& fields) const {
    struct Copy {
      const float* from;
      float* to;
    };
    std::vector<Copy> copies{{state.depth.data(), fields.depth.data()},
                             {state.momentum_x.data(), fields.momentum_x.data()},
                             {state.momentum_y.data(), fields.momentum_y.data()}};
    if (!contacts.empty()) {
      const Contacts& c = contacts.front();
      copies.insert(copies.end(), {{c.hidden.depth.data(), fields.load.data()},
                                   {c.hidden.momentum_x.data(), fields.load_momentum_x.data()},
                                   {c.hidden.momentum_y.data(), fields.load_momentum_y.data()},
                                   {c.top.data(), fields.load_elevation.data()}});
    }
    for (int j = window.row_begin; j < window.row_end; ++j) {
      const std::size_t first = grid.index(window.column_begin, j);
      const std::size_t count = static_cast<std::size_t>(window.columns());
      for (const Copy& copy : copies) std::copy_n(copy.from + first, count, copy.to + first);
      if (contacts.empty()) continue;
      const Cover* cover = contacts.front().cover.data();
      for (std::size_t k = first; k < first + count; ++k) swapIfTouching(cover[k], k, fields);
    }
  }

  /// Ground and load become what a step sees and what it does not, or the other way round.
  static void swapWhereTouching(const std::vector<Cover>& cover, Fields& fields) {
    for (std::size_t k = 0; k < cover.size(); ++k) swapIfTouching(cover[k], k, fields);
  }
  static void swapIfTouching(Cover cover, std::size_t k, Fields& fields) {
    if (cover != Cover::touching) return;
    std::swap(fields.depth[k], fields.load[k]);
    std::swap(fields.momentum_x[k], fields.load_momentum_x[k]);
    std::swap(fields.momentum_y[k], fields.load_momentum_y[k]);
  }

  ContactFields contact() {
    Contacts& c = contacts.front();
    return {c.clearance.data(),  c.top.data(),        c.headroom.data(), c.length.data(), c.velocity_x.data(),
            c.velocity_y.data(), c.velocity_z.data(), c.body.data(),     c.swept.data()};
  }
  SandColumns columns() {
    Contacts& c = contacts.front();
    return {state.layer(), c.hidden.layer(), c.visible_bed.data(), c.ceiling.data(), c.cover.data()};
  }

  VisibleSand visibleSand() {
    const bool with_bodies = !contacts.empty();
    return {{stepOf(false)}, with_bodies ? columns() : SandColumns{}, with_bodies};
  }

  /// @param near_bodies whether some column may have a body above it
  StepArguments stepOf(bool near_bodies) {
    StepArguments step{};
    const bool uniform = repose_rise.size() == 0;
    step.in = {state.depth.data(),
               state.momentum_x.data(),
               state.momentum_y.data(),
               visibleBed(),
               near_bodies ? contacts.front().ceiling.data() : nullptr,
               uniform ? nullptr : repose_rise.data(),
               uniform ? nullptr : layer_fraction.data(),
               uniform ? nullptr : layer_depth.data()};
    step.sand = sand;
    step.open = open;
    step.columns = grid.columns;
    step.rows = grid.rows;
    return step;
  }

  template <class T>
  static Memory<T> uploaded(const std::vector<T>& values) {
    Memory<T> memory(values.size());
    memory.upload(values.data(), values.size());
    return memory;
  }
  template <class T>
  static std::vector<T> downloaded(const Memory<T>& memory) {
    std::vector<T> values(memory.size());
    memory.download(values.data(), values.size());
    return values;
  }

  Grid grid;
  SandConstants sand;
  OpenEdges open;
  Memory<float> bed;
  State state;
  State next;
  Memory<float> repose_rise;  ///< these three are empty where the material is the same everywhere
  Memory<float> layer_fraction;
  Memory<float> layer_depth;
  Memory<double> left_over_edges;  ///< see CountOutflow
  std::vector<PourOnBackend> pours;
  std::vector<Memory<float>> distance_fields;
  std::vector<Contacts> contacts;  ///< none or one: maps without bodies need none

 private:
  static State uploadedState(const Fields& fields) {
    return {uploaded(fields.depth), uploaded(fields.momentum_x), uploaded(fields.momentum_y)};
  }
  const float* visibleBed() const {
    return contacts.empty() ? bed.data() : contacts.front().visible_bed.data();
  }
  static double sum(const Memory<double>& memory) {
    const std::vector<double> values = downloaded(memory);
    return std::accumulate(values.begin(), values.end(), 0.0);
  }

  template <class T>
  static void set(Memory<T>& memory, const std::vector<T>& values) {
    memory.upload(values.data(), values.size());
  }
  static void set(State& layer, const std::vector<float>& h, const std::vector<float>& hu,
                  const std::vector<float>& hv) {
    set(layer.depth, h);
    set(layer.momentum_x, hu);
    set(layer.momentum_y, hv);
  }

  void restoreContacts(const Fields& layers, const ContactSnapshot& snapshot,
                       const std::vector<Cover>& cover) {
    Contacts& c = contacts.front();
    set(c.clearance, snapshot.clearance);
    set(c.top, layers.load_elevation);
    set(c.headroom, snapshot.headroom);
    set(c.length, snapshot.length);
    set(c.velocity_x, snapshot.velocity_x);
    set(c.velocity_y, snapshot.velocity_y);
    set(c.velocity_z, snapshot.velocity_z);
    set(c.cover, cover);
    set(c.hidden, layers.load, layers.load_momentum_x, layers.load_momentum_y);
    std::vector<float> visible_bed = layers.bed;
    std::vector<float> ceiling = snapshot.clearance;
    for (std::size_t k = 0; k < cover.size(); ++k) {
      if (cover[k] != Cover::touching) continue;
      visible_bed[k] = layers.load_elevation[k];
      ceiling[k] = snapshot.headroom[k];
    }
    set(c.visible_bed, visible_bed);
    set(c.ceiling, ceiling);
  }

  /// What a body has given for each row, along x and y.
  std::size_t rowSums() const { return 2 * static_cast<std::size_t>(grid.rows); }

  std::vector<Memory<double>> given_;  // see AddGiven; none for bodies that were removed
  double edited_in_ = 0.0;             // depth, summed over cells [m]
  double edited_out_ = 0.0;
};

}  // namespace shallow_sand
