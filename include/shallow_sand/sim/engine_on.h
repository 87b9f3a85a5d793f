#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "shallow_sand/coupling/displacement.h"
#include "shallow_sand/coupling/rays.h"
#include "shallow_sand/device/window_part.h"
#include "shallow_sand/sim/engine.h"
#include "shallow_sand/solver/change_sand.h"

namespace shallow_sand {

/// Copies what the displacement wrote back to the state.
struct CopyState {
  SandFieldsOut from;
  SandFieldsOut to;
  int columns;

  SHALLOW_SAND_HOST_DEVICE void operator()(int i, int j) const {
    const long long at = static_cast<long long>(j) * columns + i;
    to.depth[at] = from.depth[at];
    to.momentum_x[at] = from.momentum_x[at];
    to.momentum_y[at] = from.momentum_y[at];
  }
};

/// The engine on one backend. Executor: HostExecutor or CudaExecutor; Stepper: what computes a step on it.
template <class Executor, class Stepper>
class EngineOn : public Engine {
  template <class T>
  using Memory = typename Executor::template Memory<T>;

 public:
  /// @param stepper what the stepper needs besides the executor
  template <class... StepperArguments>
  EngineOn(Executor executor, const EngineStart& start, const StepperArguments&... stepper)
      : executor_(std::move(executor)),
        stepper_(executor_, stepper...),
        grid_(start.grid),
        sand_(start.sand),
        open_(start.open),
        bed_(uploaded(start.fields.bed)),
        state_(uploadedState(start.fields)),
        next_(uploadedState(start.fields)),
        repose_rise_(uploaded(start.material.repose_rise)),
        layer_fraction_(uploaded(start.material.layer_fraction)),
        layer_depth_(uploaded(start.material.layer_depth)),
        left_(2 * static_cast<std::size_t>(grid_.columns + grid_.rows), 0.0) {}

  void addBody(const DistanceField& field) override {
    Memory<float> distance(field.distance.size());
    distance.upload(field.distance.data(), field.distance.size());
    distance_fields_.push_back(std::move(distance));
    if (contacts_.empty()) contacts_.emplace_back(grid_.cells());
  }

  void removeBody(std::size_t body) override { distance_fields_[body] = Memory<float>(0); }

  void addPour(const LocalRegion& region) override {
    PourOnBackend pour{changeOf(region), 0, Memory<double>(0)};
    const Window& window = pour.change.window;
    for (int j = window.row_begin; j < window.row_end; ++j) {
      for (int i = window.column_begin; i < window.column_end; ++i)
        pour.covered += pour.change.covers(i, j) ? 1 : 0;
    }
    pour.taken = Memory<double>(window.cells(), 0.0);
    pours_.push_back(std::move(pour));
  }

  void castRays(const std::vector<PlacedBody>& bodies) override {
    if (contacts_.empty()) return;
    const Window before = window_;
    window_ = Window{};
    std::vector<BodyView> views;
    for (const PlacedBody& placed : bodies) {
      BodyView view = placed.view;
      view.field.distance = distance_fields_[placed.body].data();
      views.push_back(view);
      window_ = window_.united(placed.window);
    }
    // One more column on each side is free to take sand; cells that a body has left are cast once more, to be
    // cleared.
    window_ = window_.grown(1, grid_);
    const Window cast = window_.united(before);
    if (cast.empty()) return;
    stepper_.touch(cast);
    if (views.size() > view_capacity_) {
      views_.clear();
      views_.emplace_back(views.size());
      view_capacity_ = views.size();
    }
    if (!views.empty()) views_.front().upload(views.data(), views.size());
    executor_.forEachCell(
        cast, CastRays{views_.empty() ? nullptr : views_.front().data(), static_cast<int>(views.size()),
                       state_.depth.data(), bed_.data(), contact(), grid_.columns, grid_.spacing});
  }

  void displace() override {
    if (window_.empty()) return;
    int* distance = contacts_.front().distance.data();
    executor_.forEachCell(Window::line(window_.columns()),
                          DistanceAlongColumns{contact(), state_.depth.data(), distance, grid_.columns,
                                               grid_.spacing, window_});
    executor_.forEachCell(Window::line(window_.rows()), DistanceAlongRows{distance, grid_.columns, window_});
    executor_.forEachCell(window_,
                          DisplaceSand{contact(), distance, state_.depth.data(), state_.momentum_x.data(),
                                       state_.momentum_y.data(), next_.depth.data(), next_.momentum_x.data(),
                                       next_.momentum_y.data(), grid_.columns, grid_.spacing, window_});
    executor_.forEachCell(window_, CopyState{writable(next_), writable(state_), grid_.columns});
  }

  float attempt(float dt) override {
    attempted_ = stepOf(dt);
    const float speed = stepper_.attempt(attempted_, window_, writable(next_));
    if (window_.empty()) return speed;
    return std::max(speed, executor_.maximumOverCells(window_, ContactSpeed{contact(), grid_.columns}));
  }

  long long accept() override {
    // Edge faces have no slopes.
    withStep(attempted_, !window_.empty(), false, [&](const auto& step) {
      for (const Window& side : perimeterOf(stepper_.stepped(), open_, grid_.columns, grid_.rows))
        executor_.forEachCell(side, CountOutflow<std::decay_t<decltype(step)>>{step, left_.data()});
    });
    std::swap(state_, next_);
    return stepper_.accept();
  }

  void pour(std::size_t number, double volume) override {
    PourOnBackend& p = pours_[number];
    const double depth = volume / (static_cast<double>(p.covered) * grid_.cellArea());
    p.change.operation = volume < 0.0 ? EditOperation::remove : EditOperation::add;
    p.change.value = static_cast<float>(std::abs(depth));
    apply(p.change, p.taken);
  }

  double edit(const LocalRegion& region, EditOperation operation, float value) override {
    ChangeSand change = changeOf(region);
    change.operation = operation;
    change.value = value;
    Memory<double> taken(change.window.cells(), 0.0);
    apply(change, taken);
    double grown = 0.0;
    for (const double depth : downloaded(taken)) {
      grown += depth;
      (depth > 0.0 ? edited_in_ : edited_out_) += std::abs(depth);
    }
    return grown * grid_.cellArea();
  }

  Fields fields() const override {
    return {downloaded(bed_), downloaded(state_.depth), downloaded(state_.momentum_x),
            downloaded(state_.momentum_y)};
  }

  double poured() const override {
    double depth = edited_in_;
    for (const PourOnBackend& p : pours_) depth += std::max(sum(p.taken), 0.0);
    return depth * grid_.cellArea();
  }

  double left() const override {
    double depth = sum(left_) + edited_out_;
    for (const PourOnBackend& p : pours_) depth += std::max(-sum(p.taken), 0.0);
    return depth * grid_.cellArea();
  }

  double bodyOverlap() const override {
    if (window_.empty()) return 0.0;
    const std::vector<float> overlap = inWindow(contacts_.front().overlap);
    const double depth = std::accumulate(overlap.begin(), overlap.end(), 0.0);
    return depth * grid_.cellArea();
  }

  ContactSnapshot contacts() const override {
    ContactSnapshot snapshot;
    snapshot.window = window_;
    if (window_.empty()) return snapshot;
    const Contacts& c = contacts_.front();
    snapshot.ceiling = inWindow(c.ceiling);
    snapshot.length = inWindow(c.length);
    snapshot.velocity_x = inWindow(c.velocity_x);
    snapshot.velocity_y = inWindow(c.velocity_y);
    return snapshot;
  }

  void restore(const Fields& fields, const ContactSnapshot& contacts) override {
    bed_ = uploaded(fields.bed);
    state_ = uploadedState(fields);
    next_ = uploadedState(fields);
    stepper_.touch(Window::all(grid_));
    window_ = contacts.window;
    if (contacts_.empty()) return;
    contacts_.front() = Contacts(grid_.cells());
    Contacts& c = contacts_.front();
    putInWindow(contacts.ceiling, c.ceiling);
    putInWindow(contacts.length, c.length);
    putInWindow(contacts.velocity_x, c.velocity_x);
    putInWindow(contacts.velocity_y, c.velocity_y);
  }

 private:
  struct State {
    Memory<float> depth;
    Memory<float> momentum_x;
    Memory<float> momentum_y;
  };
  static State uploadedState(const Fields& fields) {
    return {uploaded(fields.depth), uploaded(fields.momentum_x), uploaded(fields.momentum_y)};
  }

  struct Contacts {
    explicit Contacts(std::size_t cells)
        : ceiling(cells, std::numeric_limits<float>::infinity()),
          length(cells),
          velocity_x(cells),
          velocity_y(cells),
          velocity_z(cells),
          overlap(cells),
          distance(cells) {}
    Memory<float> ceiling;
    Memory<float> length;
    Memory<float> velocity_x;
    Memory<float> velocity_y;
    Memory<float> velocity_z;
    Memory<float> overlap;
    Memory<int> distance;
  };

  struct PourOnBackend {
    ChangeSand change;
    std::size_t covered;
    Memory<double> taken;
  };

  /// A change without operation, value and memory.
  ChangeSand changeOf(const LocalRegion& region) const {
    ChangeSand change{};
    change.columns = grid_.columns;
    change.spacing = grid_.spacing;
    change.region = region;
    change.window = windowOf(region, grid_);
    return change;
  }

  void apply(ChangeSand change, Memory<double>& taken) {
    change.depth = state_.depth.data();
    change.momentum_x = state_.momentum_x.data();
    change.momentum_y = state_.momentum_y.data();
    change.bed = bed_.data();
    change.taken = taken.data();
    executor_.forEachCell(change.window, change);
    stepper_.touch(change.window);
  }

  std::vector<float> inWindow(const Memory<float>& field) const {
    return partOf(downloaded(field), window_, grid_);
  }
  void putInWindow(const std::vector<float>& part, Memory<float>& field) const {
    std::vector<float> values = downloaded(field);
    putPart(part, window_, grid_, values);
    field.upload(values.data(), values.size());
  }

  static Memory<float> uploaded(const std::vector<float>& values) {
    Memory<float> memory(values.size());
    memory.upload(values.data(), values.size());
    return memory;
  }
  template <class T>
  static std::vector<T> downloaded(const Memory<T>& memory) {
    std::vector<T> values(memory.size());
    memory.download(values.data(), values.size());
    return values;
  }

  SandFieldsOut writable(State& state) const {
    return {state.depth.data(), state.momentum_x.data(), state.momentum_y.data()};
  }

  ContactFields contact() {
    Contacts& c = contacts_.front();
    return {c.ceiling.data(),    c.length.data(),     c.velocity_x.data(),
            c.velocity_y.data(), c.velocity_z.data(), c.overlap.data()};
  }

  StepArguments stepOf(float dt) {
    StepArguments step{};
    const bool uniform = repose_rise_.size() == 0;
    step.in = {state_.depth.data(),
               state_.momentum_x.data(),
               state_.momentum_y.data(),
               bed_.data(),
               window_.empty() ? nullptr : contacts_.front().ceiling.data(),
               uniform ? nullptr : repose_rise_.data(),
               uniform ? nullptr : layer_fraction_.data(),
               uniform ? nullptr : layer_depth_.data()};
    step.sand = sand_;
    step.open = open_;
    step.columns = grid_.columns;
    step.rows = grid_.rows;
    step.setTimeStep(dt);
    return step;
  }

  static double sum(const Memory<double>& memory) {
    const std::vector<double> values = downloaded(memory);
    return std::accumulate(values.begin(), values.end(), 0.0);
  }

  Executor executor_;
  Stepper stepper_;
  Grid grid_;
  SandConstants sand_;
  OpenEdges open_;
  Memory<float> bed_;
  State state_;
  State next_;
  StepArguments attempted_{};
  Memory<float> repose_rise_;  // these three are empty where the material is the same everywhere
  Memory<float> layer_fraction_;
  Memory<float> layer_depth_;
  Memory<double> left_;
  std::vector<PourOnBackend> pours_;
  double edited_in_ = 0.0;  // depth, summed over cells [m]
  double edited_out_ = 0.0;
  std::vector<Memory<float>> distance_fields_;
  std::vector<Contacts> contacts_;       // none or one: maps without bodies need none
  std::vector<Memory<BodyView>> views_;  // none or one
  std::size_t view_capacity_ = 0;
  Window window_;  // columns that bodies may touch, at the last rays
};

}  // namespace shallow_sand
