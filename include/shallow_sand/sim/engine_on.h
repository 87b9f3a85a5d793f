#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "shallow_sand/coupling/displacement.h"
#include "shallow_sand/coupling/drag.h"
#include "shallow_sand/coupling/flow_loads.h"
#include "shallow_sand/coupling/meet_bodies.h"
#include "shallow_sand/coupling/pushed_sand.h"
#include "shallow_sand/device/tile_set.h"
#include "shallow_sand/particles/grains_on_host.h"
#include "shallow_sand/sim/sand_memory.h"

namespace shallow_sand {

/// The engine whose loops the host runs. Executor: HostExecutor; Rays: what casts rays on it; Stepper: what
/// computes a step on it.
template <class Executor, class Rays, class Stepper>
class EngineOn : public SteppedEngine {
  template <class T>
  using Memory = typename Executor::template Memory<T>;
  using Sand = SandMemory<Executor::template Memory>;

 public:
  /// @param stepper what the stepper needs besides the executor
  template <class... StepperArguments>
  EngineOn(Executor executor, const Rays& rays, const EngineStart& start, const StepperArguments&... stepper)
      : executor_(std::move(executor)),
        rays_(rays),
        stepper_(executor_, stepper...),
        grid_(start.grid),
        displacement_(start.displacement),
        memory_(start),
        grains_(grainMemoryOf<Executor::template Memory>(start)),
        changed_(start.grid, kCopiedColumns, kCopiedRows),
        collected_(start.grid, kCopiedColumns, kCopiedRows) {}

  void addBody(const DistanceField& field) override {
    memory_.addBody(field);
    given_sums_ = memory_.givenSums();
  }
  void removeBody(std::size_t body) override {
    memory_.removeBody(body);
    given_sums_ = memory_.givenSums();
  }
  void addPour(const LocalRegion& region, const PourTimes& times) override { memory_.addPour(region, times); }

  void placeBodies(const std::vector<PlacedBody>& bodies, int steps) override {
    place(bodies, 1, StepRun::kHopsPerStep * steps);
  }

  void expectSand(const LocalRegion& region) override { expected_.push_back(windowOf(region, grid_)); }

  void start(const StepRun& run, std::vector<Placement> placements) override {
    std::vector<double> times;
    for (const Placement& placement : placements) times.push_back(placement.time);
    run_ = run;
    run_.placed_at = times.data();
    run_.placements = static_cast<int>(times.size());
    RunningSand sand{*this, placements};
    takeSteps(sand, run_);
    run_.placed_at = nullptr;
  }
  StepRun finish() override { return run_; }

  float attempt(float dt) override {
    attempted_ = memory_.stepOf(!windows_.empty());
    attempted_.setTimeStep(dt);
    float speed = stepper_.attempt(attempted_, windows_, memory_.next.layer());
    for (std::size_t k = 0; k < windows_.size(); ++k) {
      const ContactSpeed contact_speed{memory_.contact(), memory_.columns(), Step<true, false>{attempted_}};
      if (!sleeps(k)) watched_[k].speed = executor_.maximumOverCells(windows_[k], contact_speed);
      speed = std::max(speed, watched_[k].speed);
    }
    return speed;
  }

  long long accept() override {
    // Edge faces have no slopes.
    withStep(attempted_, !windows_.empty(), false, [&](const auto& step) {
      for (const Window& side : perimeterOf(stepper_.stepped(), memory_.open, grid_.columns, grid_.rows)) {
        executor_.forEachCell(
            side, CountOutflow<std::decay_t<decltype(step)>>{step, memory_.left_over_edges.data()});
      }
    });
    std::swap(memory_.state, memory_.next);
    for (const Window& cells : stepper_.rectangles()) changed_.add(cells);
    const long long computed = stepper_.accept();
    flowLoads();
    return computed;
  }

  void pour(std::size_t number, double volume) override {
    typename Sand::PourOnBackend& pour = memory_.pours[number];
    pour.change.pour(volume, static_cast<double>(pour.covered) * grid_.cellArea());
    apply(pour.change, pour.taken);
  }

  void setSand(const SandConstants& sand, const LocalMaterialFields& material) override {
    memory_.setSand(sand, material);
    stepper_.touch(Window::all(grid_));
  }

  double edit(const LocalRegion& region, EditOperation operation, float value) override {
    ChangeSand change = memory_.changeOf(region);
    change.operation = operation;
    change.value = value;
    return applyOnce(change);
  }
  double edit(EditOperation operation, const std::vector<float>& values) override {
    const Memory<float> uploaded = Sand::uploaded(values);
    ChangeSand change = memory_.changeOf(wholeMap());
    change.operation = operation;
    change.values = uploaded.data();
    return applyOnce(change);
  }

  Fields fields() override {
    const auto download = [](const Memory<float>& memory) { return Sand::downloaded(memory); };
    Fields fields{download(memory_.bed), download(memory_.state.depth), download(memory_.state.momentum_x),
                  download(memory_.state.momentum_y)};
    if (memory_.contacts.empty()) return fields;
    const auto& c = memory_.contacts.front();
    fields.load = download(c.hidden.depth);
    fields.load_momentum_x = download(c.hidden.momentum_x);
    fields.load_momentum_y = download(c.hidden.momentum_y);
    fields.load_elevation = download(c.top);
    memory_.swapWhereTouching(memory_.downloaded(c.cover), fields);
    return fields;
  }
  SandView view() override { return memory_.view(); }
  void requestFields() override {
    const std::vector<Window> changed = changed_.take();
    const bool has_loads = !memory_.contacts.empty();
    if (bed_is_new_ || requested_.load.empty() == has_loads) {
      bed_is_new_ = false;
      requested_ = fields();
      collected_.add(Window::all(grid_));
      return;
    }
    for (const Window& window : changed) {
      memory_.download(window, requested_);
      collected_.add(window);
    }
  }
  const Fields& collectFields() override { return requested_; }
  std::vector<Window> takeChanges() override { return collected_.take(); }

  double poured() const override { return memory_.poured(); }
  double left() const override { return memory_.left(); }

  double overlap(const std::vector<PlacedBody>& bodies) override {
    if (memory_.contacts.empty()) return 0.0;
    Memory<float> overlap(grid_.cells());
    std::vector<Window> windows;
    for (const PlacedBody& body : bodies) windows.push_back(body.window);
    for (const BodyBins& bins : binsOf(bodies, withoutOverlap(windows))) {
      rays_.forEachColumn(executor_, MeasureOverlap{overBed(bins), memory_.columns(),
                                                    memory_.contacts.front().top.data(), overlap.data()});
    }
    const std::vector<float> depths = memory_.downloaded(overlap);
    return std::accumulate(depths.begin(), depths.end(), 0.0) * grid_.cellArea();
  }

  std::vector<Eigen::Vector2d> givenMomentum() const override { return memory_.givenMomentum(); }

  void moveGrains(float duration, std::uint32_t number) override {
    std::vector<Window> awake = stepper_.due();
    // Loads may move where no tile is due.
    awake.insert(awake.end(), windows_.begin(), windows_.end());
    if (!awake.empty()) {
      ::shallow_sand::moveGrains(executor_, grains_->move(memory_.visibleSand(), duration, number), awake);
    }
  }
  std::vector<Grain> grains() override { return grains_->get(); }
  void setGrains(const std::vector<Grain>& grains) override { grains_->set(grains); }

  ContactSnapshot contacts() const override { return memory_.snapshot(windows_); }

  void restore(const Fields& fields, const ContactSnapshot& contacts) override {
    memory_.restore(fields, contacts);
    touch(Window::all(grid_));
    bed_is_new_ = true;
    windows_ = contacts.windows;
    watched_.assign(windows_.size(), Watched{});
    standing_.clear();
    apart_.clear();
  }

 private:
  /// Of which fields are copied for those who ask for them [cells].
  static constexpr int kCopiedColumns = 32;
  static constexpr int kCopiedRows = 8;

  /// What a run of steps calls.
  struct RunningSand {
    EngineOn& engine;
    const std::vector<Placement>& placements;

    float attempt(float dt) { return engine.attempt(dt); }
    long long accept() { return engine.accept(); }
    int pours() const { return static_cast<int>(engine.memory_.pours.size()); }
    PourTimes pourTimes(int k) const { return engine.memory_.pours[static_cast<std::size_t>(k)].times; }
    void pour(int k, double volume) { engine.pour(static_cast<std::size_t>(k), volume); }
    void meetBodies(bool places, int placement, int before, int hops) {
      if (!places) return engine.sortSand(hops);
      engine.place(placements[static_cast<std::size_t>(placement)].bodies, placement - before, hops);
    }
    template <class Function>
    void once(const Function& function) const {
      function();
    }
  };

  /// What is known of the sand under and on the bodies of a window.
  struct Watched {
    bool rests = false;  ///< nothing there has moved, and nothing will that sand from beside does not move
    bool flows = true;   ///< loads have moved in the last step
    float speed = 0.0f;  ///< largest, as ContactSpeed has it [m/s]
  };

  /// A window in which sand makes way.
  struct Crowded {
    BodyBins bins;
    bool cast;  ///< whether some body here has moved
  };

  bool sleeps(std::size_t k) const { return watched_[k].rests && !stepper_.isDue(windows_[k]); }

  /// @param since placements since bodies were placed the last time
  void place(const std::vector<PlacedBody>& all, int since, int hops) {
    if (memory_.contacts.empty()) return;
    placed_ = all;
    const std::vector<PlacedBody> bodies = nearSand(all);
    std::vector<Window> touched;
    // One more column on each side is free to take sand.
    for (const PlacedBody& body : bodies) touched.push_back(body.window.grown(1, grid_));
    const std::vector<Window> now = withoutOverlap(touched);
    const std::vector<Window> moved = windowsOfMoved(bodies, since);
    // Cells that a body has left are looked at once more, to be cleared.
    touched.insert(touched.end(), windows_.begin(), windows_.end());
    std::vector<Crowded> crowded;
    for (const BodyBins& bins : binsOf(bodies, withoutOverlap(touched))) {
      if (!displacement_) {
        drag(bins);
      } else if (bins.window.overlapsAny(moved)) {
        crowded.push_back({bins, true});
      } else if (!restsNow(bins.window)) {
        crowded.push_back({bins, false});
      }
    }
    makeWay(std::move(crowded), hops);
    watch(now, moved);
    standing_.clear();
    for (const PlacedBody& body : bodies) standing_[body.body] = body.window;
  }

  /// Sand has moved: what has come under bodies, or has filled the room there, is told from what has not.
  /// Where it has come near a body that was far above it, bodies are placed again.
  void sortSand(int hops) {
    if (std::any_of(apart_.begin(), apart_.end(), [&](const PlacedBody& body) { return isNearSand(body); }))
      return place(std::vector<PlacedBody>(placed_), 0, hops);
    std::vector<Crowded> crowded;
    for (const Window& window : windows_) {
      if (!restsNow(window)) crowded.push_back({BodyBins{nullptr, nullptr, nullptr, window, 0}, false});
    }
    makeWay(std::move(crowded), hops);
  }

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

  /// Where no body has moved: whether the sand has not, either.
  bool restsNow(const Window& window) {
    const auto here = std::find(windows_.begin(), windows_.end(), window);
    if (here == windows_.end()) return false;
    Watched& watched = watched_[here - windows_.begin()];
    watched.rests = !stepper_.isDue(window) && !watched.flows &&
                    (watched.rests || !executor_.holdsAny(window, sandWithoutRoom()));
    return watched.rests;
  }

  SandWithoutRoom sandWithoutRoom() { return {memory_.contact(), memory_.columns(), grid_.columns}; }

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
    if (memory_.isPouredOn(around) || around.overlapsAny(expected_)) return true;
    return executor_.holdsAny(
        around, SandAbove{memory_.columns(), reachOf(body, grid_), memory_.sand.film, grid_.columns});
  }

  /// Where bodies are, or were the last time, that do not rest.
  std::vector<Window> windowsOfMoved(const std::vector<PlacedBody>& bodies, int since) const {
    std::vector<Window> moved;
    std::map<std::size_t, Window> gone = standing_;
    for (const PlacedBody& body : bodies) {
      if (body.still > since && gone.count(body.body) != 0) {
        gone.erase(body.body);
      } else {
        moved.push_back(body.window);
      }
    }
    for (const auto& was : gone) moved.push_back(was.second);
    return moved;
  }

  /// Sand goes on by a column in each of `hops`, unless all has gone before. After the first, nothing changes
  /// in windows in which all has.
  void makeWay(std::vector<Crowded> crowded, int hops) {
    for (const Crowded& here : crowded) touch(here.bins.window);
    for (int hop = 0; hop < hops && !crowded.empty(); ++hop) {
      std::vector<Window> reached;
      for (const Crowded& here : crowded) displace(here, hop > 0, reached);
      for (const Window& window : withoutOverlap(reached)) layPushedSand(window);
      const auto isDone = [&](const Crowded& here) {
        return !executor_.holdsAny(here.bins.window, sandWithoutRoom());
      };
      if (hop + 1 < hops)
        crowded.erase(std::remove_if(crowded.begin(), crowded.end(), isDone), crowded.end());
    }
  }

  /// @param reached where sand was pushed to, and may go from there, is added to it
  void displace(const Crowded& here, bool again, std::vector<Window>& reached) {
    const Window& window = here.bins.window;
    auto& contacts = memory_.contacts.front();
    int* distance = contacts.distance.data();
    const SandLayer ground = memory_.next.layer();
    const SandLayer load = contacts.next_hidden.layer();
    const SandLayer pushed = contacts.pushed.layer();
    const MeetBodies meet{overBed(here.bins), memory_.columns(), memory_.contact(), ground, load};
    if (again) {
      executor_.forEachCell(window, MeetBodiesAgain{meet});
    } else if (here.cast) {
      rays_.forEachColumn(executor_, meet);
    } else {
      executor_.forEachCell(window, meet);
    }
    executor_.forEachCell(Window::line(window.columns()),
                          DistanceAlongColumns{memory_.contact().clearance, ground.depth, distance,
                                               grid_.columns, grid_.spacing, window});
    executor_.forEachCell(Window::line(window.rows()), DistanceAlongRows{distance, grid_.columns, window});
    const GivenInWindow given = givenIn(window);
    executor_.forEachCell(
        window, DisplaceSand{memory_.contact(), distance, ground, load, memory_.bed.data(), memory_.columns(),
                             pushed, given, grid_.columns, grid_.spacing, again});
    addGiven(given);
    for (const Window& part : executor_.partsWith(window, PushedDepth{pushed.depth, grid_.columns}))
      reached.push_back(part.grown(kPassesOfPushedSand, grid_));
  }

  /// What was pushed is 0 around what can come into the window, and everywhere in it afterwards.
  void layPushedSand(const Window& window) {
    touch(window);
    auto& contacts = memory_.contacts.front();
    const float* repose_rise = memory_.repose_rise.size() == 0 ? nullptr : memory_.repose_rise.data();
    const SandLayer pushed = contacts.pushed.layer();
    SandLayer from = pushed;
    SandLayer to = memory_.next.layer();
    executor_.forEachCell(window, NoSand{to, grid_.columns});
    auto holding = executor_.cellsWith(window, PushedDepth{from.depth, grid_.columns});
    for (int pass = 0; pass < kPassesOfPushedSand; ++pass) {
      const PushedSand sand{
          memory_.columns(), repose_rise, memory_.sand, from, contacts.next_hidden.depth.data(),
          grid_.columns,     window};
      const auto near = executor_.grown(holding);
      executor_.forEachCell(holding, DividePushedSand{sand});
      executor_.forEachCell(near, LowerPushedSand{sand, to});
      holding = executor_.cellsWith(near, PushedDepth{to.depth, grid_.columns});
      std::swap(from, to);
    }
    executor_.forEachCell(holding, LayPushedSand{memory_.columns(), pushed, grid_.columns});
  }

  void drag(const BodyBins& bins) {
    touch(bins.window);
    rays_.forEachColumn(executor_,
                        FindSubmerged{overBed(bins), memory_.state.depth.data(), memory_.contact()});
    const GivenInWindow given = givenIn(bins.window);
    executor_.forEachCell(
        bins.window, DragSand{memory_.contact(), memory_.state.layer(), grid_.columns, grid_.spacing, given});
    addGiven(given);
  }

  /// Room for what bodies give to a window's sand, until it is added up.
  GivenInWindow givenIn(const Window& window) {
    if (given_.size() < window.cells()) {
      given_ = Memory<GivenMomentum>(window.cells());
      some_given_ = Memory<std::uint8_t>(window.cells());
    }
    return {given_.data(), some_given_.data(), window};
  }
  void addGiven(const GivenInWindow& given) {
    executor_.forEachCell(Window::line(given.window.rows()),
                          AddGiven{given, memory_.contact().body, given_sums_.data(), grid_.columns});
  }

  void flowLoads() {
    for (std::size_t k = 0; k < windows_.size(); ++k) {
      if (sleeps(k)) continue;
      const Window& window = windows_[k];
      watched_[k].rests = false;
      FlowLoads flow{Step<true, false>{attempted_},
                     memory_.columns(),
                     memory_.contact(),
                     memory_.bed.data(),
                     memory_.contacts.front().flowed.data(),
                     memory_.next.layer(),
                     memory_.contacts.front().next_hidden.layer()};
      const auto near = executor_.grown(executor_.cellsWith(window, HangingCover{flow}));
      executor_.forEachCell(near, flow);
      watched_[k].flows = executor_.holdsAny(near, FlowedSand{flow});
      if (!watched_[k].flows) continue;
      touch(window);
      executor_.forEachCell(near, CopyLoads{flow});
    }
  }

  /// For each window, the bodies in it; valid until the next call.
  std::vector<BodyBins> binsOf(const std::vector<PlacedBody>& bodies, const std::vector<Window>& windows) {
    std::vector<BodyView> views;
    for (const PlacedBody& placed : bodies) {
      views.push_back(placed.view);
      views.back().field.distance = memory_.distance_fields[placed.body].data();
      views.back().number = static_cast<int>(placed.body);
    }
    views_ = std::move(views);
    lists_ = binLists(bodies, windows);
    std::vector<BodyBins> bins;
    for (std::size_t k = 0; k < windows.size(); ++k) {
      bins.push_back({views_.data(), lists_.first.data() + lists_.first_begins[k], lists_.members.data(),
                      windows[k], lists_.across[k]});
    }
    return bins;
  }

  double applyOnce(ChangeSand& change) {
    Memory<double> taken(change.window.cells(), 0.0);
    apply(change, taken);
    return memory_.book(taken);
  }
  void apply(ChangeSand& change, Memory<double>& taken) {
    memory_.bind(change, taken);
    executor_.forEachCell(change.window, change);
    touch(change.window);
  }

  /// The cells change, and what is beside them may have to be stepped.
  void touch(const Window& cells) {
    stepper_.touch(cells);
    changed_.add(cells);
  }

  BodiesOverBed overBed(const BodyBins& bins) const {
    return {bins, memory_.bed.data(), grid_.columns, grid_.spacing};
  }

  Executor executor_;
  Rays rays_;
  Stepper stepper_;
  Grid grid_;
  bool displacement_;
  Sand memory_;
  std::optional<GrainMemory<Executor::template Memory>> grains_;
  StepArguments attempted_{};
  StepRun run_{};
  Fields requested_;
  bool bed_is_new_ = true;          // since fields were requested the last time
  TileSet changed_;                 // since then
  TileSet collected_;               // where they have changed that nobody was told of
  Memory<GivenMomentum> given_{0};  // in the window that sand makes way in
  Memory<std::uint8_t> some_given_{0};
  std::vector<double*> given_sums_;  // see AddGiven
  std::vector<BodyView> views_;
  BinLists lists_;
  std::map<std::size_t, Window> standing_;  // columns of each body, when they were placed the last time
  std::vector<PlacedBody> placed_;          // then, those apart included
  std::vector<PlacedBody> apart_;           // bodies too high above the sand to touch it
  std::vector<Window> expected_;            // where sand will come down before bodies are placed again
  std::vector<Watched> watched_;            // of each of the windows
  std::vector<Window> windows_;  // columns that bodies may touch, at the last rays; they do not overlap
};

}  // namespace shallow_sand
