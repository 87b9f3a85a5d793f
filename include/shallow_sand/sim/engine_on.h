#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "shallow_sand/coupling/displacement.h"
#include "shallow_sand/coupling/drag.h"
#include "shallow_sand/coupling/flow_loads.h"
#include "shallow_sand/coupling/meet_bodies.h"
#include "shallow_sand/coupling/pushed_sand.h"
#include "shallow_sand/sim/engine.h"
#include "shallow_sand/solver/change_sand.h"

namespace shallow_sand {

/// The engine on one backend. Executor: HostExecutor or CudaExecutor; Rays: what casts rays on it; Stepper:
/// what computes a step on it.
template <class Executor, class Rays, class Stepper>
class EngineOn : public Engine {
  template <class T>
  using Memory = typename Executor::template Memory<T>;

 public:
  /// @param stepper what the stepper needs besides the executor
  template <class... StepperArguments>
  EngineOn(Executor executor, const Rays& rays, const EngineStart& start, const StepperArguments&... stepper)
      : executor_(std::move(executor)),
        rays_(rays),
        stepper_(executor_, stepper...),
        grid_(start.grid),
        sand_(start.sand),
        open_(start.open),
        displacement_(start.displacement),
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
    if (contacts_.empty()) contacts_.emplace_back(bed_);
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

  void moveBodies(const std::vector<PlacedBody>& all, int hops) override {
    if (contacts_.empty()) return;
    const std::vector<PlacedBody> bodies = nearSand(all);
    std::vector<Window> touched;
    // One more column on each side is free to take sand.
    for (const PlacedBody& body : bodies) touched.push_back(body.window.grown(1, grid_));
    const std::vector<Window> now = withoutOverlap(touched);
    const std::vector<Window> moved = windowsOfMoved(bodies);
    // Cells that a body has left are looked at once more, to be cleared.
    touched.insert(touched.end(), windows_.begin(), windows_.end());
    forEachBins(bodies, withoutOverlap(touched), [&](const BodyBins& bins) {
      if (!displacement_) return drag(bins);
      if (bins.window.overlapsAny(moved)) return makeWay(bins, hops, true);
      sortSand(bins.window, hops);
    });
    watch(now, moved);
    standing_.clear();
    for (const PlacedBody& body : bodies) standing_[body.body] = body.window;
  }

  bool sortSand(int hops) override {
    if (std::any_of(apart_.begin(), apart_.end(), [&](const PlacedBody& body) { return isNearSand(body); }))
      return false;
    for (const Window& window : windows_) sortSand(window, hops);
    return true;
  }

  void expectSand(const LocalRegion& region) override { expected_.push_back(windowOf(region, grid_)); }

  float attempt(float dt) override {
    attempted_ = stepOf(dt);
    float speed = stepper_.attempt(attempted_, windows_, layer(next_));
    for (std::size_t k = 0; k < windows_.size(); ++k) {
      const ContactSpeed contact_speed{contact(), columns(), Step<true, false>{attempted_}};
      if (!sleeps(k)) watched_[k].speed = executor_.maximumOverCells(windows_[k], contact_speed);
      speed = std::max(speed, watched_[k].speed);
    }
    return speed;
  }

  long long accept() override {
    // Edge faces have no slopes.
    withStep(attempted_, !windows_.empty(), false, [&](const auto& step) {
      for (const Window& side : perimeterOf(stepper_.stepped(), open_, grid_.columns, grid_.rows))
        executor_.forEachCell(side, CountOutflow<std::decay_t<decltype(step)>>{step, left_.data()});
    });
    std::swap(state_, next_);
    const long long computed = stepper_.accept();
    flowLoads();
    return computed;
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
    Fields fields{downloaded(bed_), downloaded(state_.depth), downloaded(state_.momentum_x),
                  downloaded(state_.momentum_y)};
    if (contacts_.empty()) return fields;
    const Contacts& c = contacts_.front();
    fields.load = downloaded(c.hidden.depth);
    fields.load_momentum_x = downloaded(c.hidden.momentum_x);
    fields.load_momentum_y = downloaded(c.hidden.momentum_y);
    fields.load_elevation = downloaded(c.top);
    swapWhereTouching(downloaded(c.cover), fields);
    return fields;
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

  double overlap(const std::vector<PlacedBody>& bodies) override {
    if (contacts_.empty()) return 0.0;
    Memory<float> overlap(grid_.cells());
    std::vector<Window> windows;
    for (const PlacedBody& body : bodies) windows.push_back(body.window);
    forEachBins(bodies, withoutOverlap(windows), [&](const BodyBins& bins) {
      rays_.forEachColumn(
          executor_, MeasureOverlap{overBed(bins), columns(), contacts_.front().top.data(), overlap.data()});
    });
    const std::vector<float> depths = downloaded(overlap);
    return std::accumulate(depths.begin(), depths.end(), 0.0) * grid_.cellArea();
  }

  ContactSnapshot contacts() const override {
    ContactSnapshot snapshot;
    snapshot.windows = windows_;
    if (windows_.empty()) return snapshot;
    const Contacts& c = contacts_.front();
    snapshot.clearance = downloaded(c.clearance);
    snapshot.headroom = downloaded(c.headroom);
    snapshot.length = downloaded(c.length);
    snapshot.velocity_x = downloaded(c.velocity_x);
    snapshot.velocity_y = downloaded(c.velocity_y);
    snapshot.velocity_z = downloaded(c.velocity_z);
    for (const Cover cover : downloaded(c.cover)) snapshot.cover.push_back(static_cast<float>(cover));
    return snapshot;
  }

  void restore(const Fields& fields, const ContactSnapshot& contacts) override {
    bed_ = uploaded(fields.bed);
    stepper_.touch(Window::all(grid_));
    windows_ = contacts.windows;
    watched_.assign(windows_.size(), Watched{});
    standing_.clear();
    apart_.clear();
    std::vector<Cover> cover;
    for (const float value : contacts.cover) cover.push_back(static_cast<Cover>(static_cast<int>(value)));
    Fields layers = fields;
    if (!windows_.empty()) swapWhereTouching(cover, layers);
    state_ = uploadedState(layers);
    next_ = uploadedState(layers);
    if (contacts_.empty()) return;
    contacts_.front() = Contacts(bed_);
    if (!windows_.empty()) restoreContacts(layers, contacts, cover);
  }

 private:
  struct State {
    explicit State(std::size_t cells) : depth(cells), momentum_x(cells), momentum_y(cells) {}
    State(Memory<float> h, Memory<float> hu, Memory<float> hv)
        : depth(std::move(h)), momentum_x(std::move(hu)), momentum_y(std::move(hv)) {}
    Memory<float> depth;
    Memory<float> momentum_x;
    Memory<float> momentum_y;
  };
  static State uploadedState(const Fields& fields) {
    return {uploaded(fields.depth), uploaded(fields.momentum_x), uploaded(fields.momentum_y)};
  }

  struct Contacts {
    explicit Contacts(const Memory<float>& bed)
        : clearance(bed.size(), std::numeric_limits<float>::infinity()),
          top(bed.size()),
          headroom(bed.size(), std::numeric_limits<float>::infinity()),
          length(bed.size()),
          velocity_x(bed.size()),
          velocity_y(bed.size()),
          velocity_z(bed.size()),
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

  /// What is known of the sand under and on the bodies of a window.
  struct Watched {
    bool rests = false;  ///< nothing there has moved, and nothing will that sand from beside does not move
    bool flows = true;   ///< loads have moved in the last step
    float speed = 0.0f;  ///< largest, as ContactSpeed has it [m/s]
  };

  bool sleeps(std::size_t k) const { return watched_[k].rests && !stepper_.isDue(windows_[k]); }

  /// What is known goes on where no body has moved.
  void watch(const std::vector<Window>& now, const std::vector<Window>& moved) {
    std::vector<Watched> watched(now.size());
    for (std::size_t k = 0; k < now.size(); ++k) {
      const auto was = std::find(windows_.begin(), windows_.end(), now[k]);
      if (!now[k].overlapsAny(moved) && was != windows_.end()) watched[k] = watched_[was - windows_.begin()];
    }
    windows_ = now;
    watched_ = std::move(watched);
  }

  /// Where no body has moved.
  void sortSand(const Window& window, int hops) {
    const auto here = std::find(windows_.begin(), windows_.end(), window);
    if (here != windows_.end()) {
      Watched& watched = watched_[here - windows_.begin()];
      const SandWithoutRoom rest{contact(), columns(), grid_.columns};
      watched.rests =
          !stepper_.isDue(window) && !watched.flows && (watched.rests || !executor_.holdsAny(window, rest));
      if (watched.rests) return;
    }
    makeWay(BodyBins{nullptr, nullptr, nullptr, window, 0}, hops, false);
  }

  /// Those of the bodies that sand may touch before they are placed again; the others are apart.
  std::vector<PlacedBody> nearSand(const std::vector<PlacedBody>& all) {
    std::vector<PlacedBody> near;
    apart_.clear();
    for (const PlacedBody& body : all) (isNearSand(body) ? near : apart_).push_back(body);
    expected_.clear();
    return near;
  }
  bool isNearSand(const PlacedBody& body) {
    const Window around = body.window.grown(1, grid_);
    const bool poured_on = std::any_of(pours_.begin(), pours_.end(), [&](const PourOnBackend& pour) {
      return !around.overlap(pour.change.window).empty();
    });
    if (poured_on || around.overlapsAny(expected_)) return true;
    const float reach = body.view.low.z - kNearSand * grid_.spacing;
    return executor_.holdsAny(around, SandAbove{columns(), reach, sand_.film, grid_.columns});
  }

  /// Where bodies are, or were the last time, that do not rest.
  std::vector<Window> windowsOfMoved(const std::vector<PlacedBody>& bodies) const {
    std::vector<Window> moved;
    std::map<std::size_t, Window> gone = standing_;
    for (const PlacedBody& body : bodies) {
      if (body.rests && gone.count(body.body) != 0) {
        gone.erase(body.body);
      } else {
        moved.push_back(body.window);
      }
    }
    for (const auto& was : gone) moved.push_back(was.second);
    return moved;
  }

  /// Sand goes on by a column in each of `hops`, unless all has gone before.
  /// @param cast whether some body here has moved
  void makeWay(const BodyBins& bins, int hops, bool cast) {
    stepper_.touch(bins.window);
    for (int hop = 0; hop < hops; ++hop) {
      displace(bins, cast && hop == 0);
      const SandWithoutRoom rest{contact(), columns(), grid_.columns};
      if (hop + 1 < hops && !executor_.holdsAny(bins.window, rest)) return;
    }
  }

  void displace(const BodyBins& bins, bool cast) {
    const Window& window = bins.window;
    int* distance = contacts_.front().distance.data();
    const SandLayer ground = layer(next_);
    const SandLayer load = layer(contacts_.front().next_hidden);
    const SandLayer pushed = layer(contacts_.front().pushed);
    const MeetBodies meet{overBed(bins), columns(), contact(), ground, load};
    if (cast) {
      rays_.forEachColumn(executor_, meet);
    } else {
      executor_.forEachCell(window, meet);
    }
    executor_.forEachCell(Window::line(window.columns()),
                          DistanceAlongColumns{contact().clearance, ground.depth, distance, grid_.columns,
                                               grid_.spacing, window});
    executor_.forEachCell(Window::line(window.rows()), DistanceAlongRows{distance, grid_.columns, window});
    executor_.forEachCell(window, DisplaceSand{contact(), distance, ground, load, bed_.data(), columns(),
                                               pushed, grid_.columns, grid_.spacing, window});
    std::vector<Window> reached = executor_.partsWith(window, PushedDepth{pushed.depth, grid_.columns});
    for (Window& part : reached) part = part.grown(kPassesOfPushedSand, grid_);
    for (const Window& part : withoutOverlap(reached)) layPushedSand(part, pushed);
  }

  /// `pushed` is 0 around what can come into the window, and everywhere in it afterwards.
  void layPushedSand(const Window& window, const SandLayer& pushed) {
    stepper_.touch(window);
    const float* repose_rise = repose_rise_.size() == 0 ? nullptr : repose_rise_.data();
    SandLayer from = pushed;
    SandLayer to = layer(next_);
    executor_.forEachCell(window, NoSand{to, grid_.columns});
    auto holding = executor_.cellsWith(window, PushedDepth{from.depth, grid_.columns});
    for (int pass = 0; pass < kPassesOfPushedSand; ++pass) {
      const PushedSand sand{
          columns(),     repose_rise, sand_, from, contacts_.front().next_hidden.depth.data(),
          grid_.columns, window};
      const auto near = executor_.grown(holding);
      executor_.forEachCell(holding, DividePushedSand{sand});
      executor_.forEachCell(near, LowerPushedSand{sand, to});
      holding = executor_.cellsWith(near, PushedDepth{to.depth, grid_.columns});
      std::swap(from, to);
    }
    executor_.forEachCell(holding, LayPushedSand{columns(), pushed, grid_.columns});
  }

  void drag(const BodyBins& bins) {
    stepper_.touch(bins.window);
    rays_.forEachColumn(executor_, FindSubmerged{overBed(bins), state_.depth.data(), contact()});
    executor_.forEachCell(bins.window,
                          DragSand{contact(), layer(state_), grid_.columns, grid_.spacing, bins.window});
  }

  void flowLoads() {
    for (std::size_t k = 0; k < windows_.size(); ++k) {
      if (sleeps(k)) continue;
      const Window& window = windows_[k];
      watched_[k].rests = false;
      FlowLoads flow{Step<true, false>{attempted_},
                     columns(),
                     contact(),
                     bed_.data(),
                     contacts_.front().flowed.data(),
                     layer(next_),
                     layer(contacts_.front().next_hidden)};
      const auto near = executor_.grown(executor_.cellsWith(window, HangingCover{flow}));
      executor_.forEachCell(near, flow);
      watched_[k].flows = executor_.holdsAny(near, FlowedSand{flow});
      if (!watched_[k].flows) continue;
      stepper_.touch(window);
      executor_.forEachCell(near, CopyLoads{flow});
    }
  }

  /// Calls function(bins) for each window, with the bodies in it.
  template <class Function>
  void forEachBins(const std::vector<PlacedBody>& bodies, const std::vector<Window>& windows,
                   const Function& function) {
    std::vector<BodyView> views;
    for (const PlacedBody& placed : bodies) {
      views.push_back(placed.view);
      views.back().field.distance = distance_fields_[placed.body].data();
    }
    const BinLists lists = binLists(bodies, windows);
    views_.upload(views);
    bin_first_.upload(lists.first);
    bin_members_.upload(lists.members);
    for (std::size_t k = 0; k < windows.size(); ++k) {
      function(BodyBins{views_.data(), bin_first_.data() + lists.first_begins[k], bin_members_.data(),
                        windows[k], lists.across[k]});
    }
  }

  /// Ground and load become what a step sees and what it does not, or the other way round.
  static void swapWhereTouching(const std::vector<Cover>& cover, Fields& fields) {
    for (std::size_t k = 0; k < cover.size(); ++k) {
      if (cover[k] != Cover::touching) continue;
      std::swap(fields.depth[k], fields.load[k]);
      std::swap(fields.momentum_x[k], fields.load_momentum_x[k]);
      std::swap(fields.momentum_y[k], fields.load_momentum_y[k]);
    }
  }

  void restoreContacts(const Fields& layers, const ContactSnapshot& contacts,
                       const std::vector<Cover>& cover) {
    Contacts& c = contacts_.front();
    c.clearance = uploaded(contacts.clearance);
    c.top = uploaded(layers.load_elevation);
    c.headroom = uploaded(contacts.headroom);
    c.length = uploaded(contacts.length);
    c.velocity_x = uploaded(contacts.velocity_x);
    c.velocity_y = uploaded(contacts.velocity_y);
    c.velocity_z = uploaded(contacts.velocity_z);
    c.cover = uploaded(cover);
    c.hidden = {uploaded(layers.load), uploaded(layers.load_momentum_x), uploaded(layers.load_momentum_y)};
    std::vector<float> bed = layers.bed;
    std::vector<float> ceiling = contacts.clearance;
    for (std::size_t k = 0; k < cover.size(); ++k) {
      if (cover[k] != Cover::touching) continue;
      bed[k] = layers.load_elevation[k];
      ceiling[k] = contacts.headroom[k];
    }
    c.visible_bed = uploaded(bed);
    c.ceiling = uploaded(ceiling);
  }

  /// Memory for lists whose length changes from step to step.
  template <class T>
  class GrowingMemory {
   public:
    void upload(const std::vector<T>& values) {
      if (values.size() > memory_.size()) memory_ = Memory<T>(values.size());
      if (!values.empty()) memory_.upload(values.data(), values.size());
    }
    const T* data() const { return memory_.data(); }

   private:
    Memory<T> memory_{0};
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
    change.bed = visibleBed();
    if (!contacts_.empty()) {
      const SandLayer loads = columns().hidden;
      change.hanging = {loads.depth,   loads.momentum_x,  loads.momentum_y,
                        contact().top, columns().ceiling, columns().cover};
    }
    change.taken = taken.data();
    executor_.forEachCell(change.window, change);
    stepper_.touch(change.window);
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

  static SandLayer layer(State& state) {
    return {state.depth.data(), state.momentum_x.data(), state.momentum_y.data()};
  }

  BodiesOverBed overBed(const BodyBins& bins) const {
    return {bins, bed_.data(), grid_.columns, grid_.spacing};
  }

  ContactFields contact() {
    Contacts& c = contacts_.front();
    return {c.clearance.data(),  c.top.data(),        c.headroom.data(),   c.length.data(),
            c.velocity_x.data(), c.velocity_y.data(), c.velocity_z.data(), c.swept.data()};
  }

  SandColumns columns() {
    Contacts& c = contacts_.front();
    return {layer(state_), layer(c.hidden), c.visible_bed.data(), c.ceiling.data(), c.cover.data()};
  }

  const float* visibleBed() const {
    return contacts_.empty() ? bed_.data() : contacts_.front().visible_bed.data();
  }

  StepArguments stepOf(float dt) {
    StepArguments step{};
    const bool uniform = repose_rise_.size() == 0;
    step.in = {state_.depth.data(),
               state_.momentum_x.data(),
               state_.momentum_y.data(),
               visibleBed(),
               windows_.empty() ? nullptr : contacts_.front().ceiling.data(),
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

  static constexpr float kNearSand = 4.0f;       ///< higher above sand, a body is not looked at [cells]
  static constexpr int kPassesOfPushedSand = 8;  ///< even

  static double sum(const Memory<double>& memory) {
    const std::vector<double> values = downloaded(memory);
    return std::accumulate(values.begin(), values.end(), 0.0);
  }

  Executor executor_;
  Rays rays_;
  Stepper stepper_;
  Grid grid_;
  SandConstants sand_;
  OpenEdges open_;
  bool displacement_;
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
  std::vector<Contacts> contacts_;  // none or one: maps without bodies need none
  GrowingMemory<BodyView> views_;
  GrowingMemory<int> bin_first_;
  GrowingMemory<int> bin_members_;
  std::map<std::size_t, Window> standing_;  // columns of each body, when they were placed the last time
  std::vector<PlacedBody> apart_;           // bodies too high above the sand to touch it
  std::vector<Window> expected_;            // where sand will come down before bodies are placed again
  std::vector<Watched> watched_;            // of each of the windows
  std::vector<Window> windows_;  // columns that bodies may touch, at the last rays; they do not overlap
};

}  // namespace shallow_sand
