#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "shallow_sand/coupling/displacement.h"
#include "shallow_sand/coupling/rays.h"
#include "shallow_sand/sim/engine.h"
#include "shallow_sand/solver/pour_sand.h"

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

  void addPour(float center_x, float center_y, float radius) override {
    const auto cell = [&](float position) { return static_cast<int>(std::floor(position / grid_.spacing)); };
    PourSand pour{};
    pour.columns = grid_.columns;
    pour.spacing = grid_.spacing;
    pour.center_x = center_x;
    pour.center_y = center_y;
    // A disc between the centres of cells falls on the nearest ones.
    pour.radius = std::max(radius, 0.71f * grid_.spacing);
    pour.window = {std::max(cell(center_x - pour.radius), 0), std::max(cell(center_y - pour.radius), 0),
                   std::min(cell(center_x + pour.radius) + 1, grid_.columns),
                   std::min(cell(center_y + pour.radius) + 1, grid_.rows)};
    std::size_t covered = 0;
    for (int j = pour.window.row_begin; j < pour.window.row_end; ++j) {
      for (int i = pour.window.column_begin; i < pour.window.column_end; ++i)
        covered += pour.covers(i, j) ? 1 : 0;
    }
    const std::size_t cells = static_cast<std::size_t>(pour.window.columns()) * pour.window.rows();
    pours_.push_back({pour, covered, Memory<double>(cells, 0.0)});
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
    if (open_.x_min || open_.x_max || open_.y_min || open_.y_max) {
      // Edge faces have no slopes.
      withStep(attempted_, !window_.empty(), false, [&](const auto& step) {
        executor_.forEachCell(Window::line(static_cast<int>(left_.size())),
                              CountOutflow<std::decay_t<decltype(step)>>{step, left_.data()});
      });
    }
    std::swap(state_, next_);
    return stepper_.accept();
  }

  void pour(std::size_t number, double volume) override {
    PourOnBackend& p = pours_[number];
    p.pour.depth = state_.depth.data();
    p.pour.poured = p.poured.data();
    p.pour.amount = static_cast<float>(volume / (static_cast<double>(p.covered) * grid_.cellArea()));
    executor_.forEachCell(p.pour.window, p.pour);
    stepper_.touch(p.pour.window);
  }

  Fields fields() const override {
    return {downloaded(bed_), downloaded(state_.depth), downloaded(state_.momentum_x),
            downloaded(state_.momentum_y)};
  }

  double poured() const override {
    double depth = 0.0;
    for (const PourOnBackend& p : pours_) depth += sum(p.poured);
    return depth * grid_.cellArea();
  }

  double left() const override { return sum(left_) * grid_.cellArea(); }

  double bodyOverlap() const override {
    if (window_.empty()) return 0.0;
    const std::vector<float> overlap = downloaded(contacts_.front().overlap);
    double depth = 0.0;
    for (int j = window_.row_begin; j < window_.row_end; ++j) {
      for (int i = window_.column_begin; i < window_.column_end; ++i) depth += overlap[grid_.index(i, j)];
    }
    return depth * grid_.cellArea();
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
    PourSand pour;
    std::size_t covered;
    Memory<double> poured;
  };

  static Memory<float> uploaded(const std::vector<float>& values) {
    Memory<float> memory(values.size());
    memory.upload(values.data(), values.size());
    return memory;
  }
  static std::vector<float> downloaded(const Memory<float>& memory) {
    std::vector<float> values(memory.size());
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
    step.dt = dt;
    step.per_time = 1.0f / dt;
    step.rate = grid_.spacing / dt;
    step.per_length = dt / grid_.spacing;
    return step;
  }

  static double sum(const Memory<double>& memory) {
    std::vector<double> values(memory.size());
    memory.download(values.data(), values.size());
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
  std::vector<Memory<float>> distance_fields_;
  std::vector<Contacts> contacts_;       // none or one: maps without bodies need none
  std::vector<Memory<BodyView>> views_;  // none or one
  std::size_t view_capacity_ = 0;
  Window window_;  // columns that bodies may touch, at the last rays
};

}  // namespace shallow_sand
