#pragma once

#include "shallow_sand/coupling/displacement.h"
#include "shallow_sand/coupling/drag.h"
#include "shallow_sand/coupling/flow_loads.h"
#include "shallow_sand/coupling/meet_bodies.h"
#include "shallow_sand/coupling/pushed_sand.h"
#include "shallow_sand/sim/run_tables.h"
#include "shallow_sand/sim/step_run.h"
#include "shallow_sand/solver/change_sand.h"
#include "shallow_sand/solver/due_tiles.cuh"

namespace shallow_sand {

/// The bodies of a run.
struct BodiesOnGpu {
  int count;
  /// These are lists of lists: for each placement, from that before the run on, one for each body.
  const BodyView* views;
  const BodyReach* reaches;
  unsigned char* apart;  ///< of each body, whether it is far above the sand
  bool displacement;
  const CrowdedWindow* windows;  ///< that hold all columns bodies touch, and have touched
  int window_count;
  const CellBlock* blocks;  ///< of the windows
  int block_count;
  const Window* wide_windows;  ///< that hold all columns that sand may be pushed to
  const CellBlock* wide_blocks;
  int wide_block_count;
  const int* bin_first;  ///< see BodyBins
  const int* bin_members;
  const float* bed;
  ContactFields contact;
  SandColumns columns;  ///< at the start of the run
  SandLayer next_hidden;
  SandLayer pushed;
  GivenMomentum* given;  ///< of all cells of the windows, until it is added up
  std::uint8_t* some_given;
  double* const* given_sums;  ///< see AddGiven
  int* distance;
  std::uint8_t* flowed;
  int* rests;  ///< what is known of the sand under and on bodies: whether it rests, whether loads flow

  /// The bodies of a placement, whose views begin there, over a window.
  /// @param left_out see BodyBins::apart
  __device__ BodiesOverBed overBed(int window, long long first_view, const std::uint8_t* left_out,
                                   const StepArguments& step) const {
    const CrowdedWindow& here = windows[window];
    return {BodyBins{views + first_view, bin_first + here.first_bin, bin_members, here.cells,
                     here.bins_across, left_out},
            bed, step.columns, step.sand.spacing};
  }
  __device__ GivenInWindow givenIn(int window) const {
    const CrowdedWindow& here = windows[window];
    return {given + here.first_cell, some_given + here.first_cell, here.cells};
  }
};

struct PourOnGpu {
  ChangeSand change;  ///< of the state at the start of the run
  double area;        ///< [m²]
  PourTimes times;
};

/// What a run of steps on the GPU works on.
struct GpuRun {
  StepArguments step;  ///< of the state at the start of the run; Δt is not set
  SandLayer state;     ///< the same
  SandLayer next;      ///< the other state
  DueTiles tiles;
  StepNumber first_step;
  double* left;  ///< see CountOutflow
  const PourOnGpu* pours;
  int pour_count;
  BodiesOnGpu bodies;
  Ballots* ballots;
};

/// Where a run of steps is, once for each block: what all threads know needs no registers of each.
struct RunInBlock {
  StepRun run;
  bool flipped;       ///< the state is where the next one was at the start of the run
  float dt;           ///< of the last attempt [s]
  StepNumber number;  ///< of the step that is to be taken
  int computed;       ///< cells of the last attempt
  int placement;      ///< in which bodies are
  bool rests;         ///< nothing under or on bodies has moved, and nothing will by itself
  bool flows;         ///< loads have moved in the last step
};

/// The sand in a run of steps, as takeSteps wants it; every thread of a cooperative launch holds one, and
/// they do all things together.
template <bool with_bodies, bool with_slopes>
class SandOnGpu {
 public:
  /// @param here of the block; is set
  __device__ SandOnGpu(const GpuRun& run, const StepRun& start, RunInBlock& here)
      : run_(run), bodies_(run.bodies), tiles_(run.tiles), here_(here), team_(run.ballots) {
    once([&] {
      here_.run = start;
      here_.flipped = false;
      here_.number = run_.first_step;
      here_.placement = start.placement;
      here_.rests = with_bodies && bodies_.rests[0] != 0;
      here_.flows = !with_bodies || bodies_.rests[1] != 0;
    });
    if (with_bodies) markTilesNearBodies();
  }

  /// Leaves what the host and the next run have to know.
  __device__ void finish(StepRun* result) const {
    if (!team_.isFirst()) return;
    *result = here_.run;
    if (!with_bodies) return;
    bodies_.rests[0] = here_.rests ? 1 : 0;
    bodies_.rests[1] = here_.flows ? 1 : 0;
  }

  /// One thread of each block calls the function, when all know what was known before.
  template <class Function>
  __device__ void once(const Function& function) const {
    __syncthreads();
    if (threadIdx.x == 0 && threadIdx.y == 0) function();
    __syncthreads();
  }

  __device__ float attempt(float dt) {
    const int list = DueTiles::listOf(here_.number);
    once([&] {
      here_.dt = dt;
      here_.computed = tiles_.cells[list];
      // Sand beside a body may come to it.
      if (with_bodies && tiles_.crowded[list] != 0) here_.rests = false;
    });
    if (team_.isFirst()) tiles_.empty(DueTiles::listOf(here_.number + 2));
    const int due = tiles_.lengths[list];
    float fastest = 0.0f;
    for (int k = static_cast<int>(blockIdx.x); k < due; k += static_cast<int>(gridDim.x)) {
      const int tile = tiles_.tile(list, k);
      const bool near_bodies = with_bodies && tiles_.is_near[tile] != 0;
      const float speed = block_maximum_(near_bodies ? stepped<with_bodies>(tile) : stepped<false>(tile));
      if (threadIdx.x != 0 || threadIdx.y != 0) continue;
      fastest = maximum(fastest, speed);
      tiles_.speeds[tile] = speed;
      tiles_.changed[tile] = 1;
    }
    // What sleeps has the speeds that it had.
    for (int tile = static_cast<int>(team_.thread()); tile < tiles_.count;
         tile += static_cast<int>(team_.threads())) {
      if (!tiles_.isDue(tile, here_.number)) fastest = maximum(fastest, tiles_.speeds[tile]);
    }
    if (with_bodies) {
      const ContactSpeed contact_speed{bodies_.contact, columns(), Step<true, false>{arguments()}};
      forEachCell([&](int i, int j, int) { fastest = maximum(fastest, contact_speed(i, j)); });
    }
    return team_.maximum(fastest);
  }

  __device__ long long accept() {
    countOutflow();
    once([&] {
      here_.flipped = !here_.flipped;
      here_.number += 1;
    });
    if (with_bodies && !here_.rests) flowLoads();
    return here_.computed;
  }

  __device__ int pours() const { return run_.pour_count; }
  __device__ PourTimes pourTimes(int k) const { return run_.pours[k].times; }
  __device__ void pour(int k, double volume) {
    ChangeSand change = run_.pours[k].change;
    const SandLayer sand = state();
    change.depth = sand.depth;
    change.momentum_x = sand.momentum_x;
    change.momentum_y = sand.momentum_y;
    change.pour(volume, run_.pours[k].area);
    const unsigned columns = static_cast<unsigned>(change.window.columns());
    const unsigned cells = columns * static_cast<unsigned>(change.window.rows());
    for (unsigned cell = team_.thread(); cell < cells; cell += team_.threads()) {
      const int i = change.window.column_begin + static_cast<int>(cell % columns);
      const int j = change.window.row_begin + static_cast<int>(cell / columns);
      if (!change.covers(i, j)) continue;
      change(i, j);
      tiles_.touch(i, j, here_.number);
    }
    team_.wait();
  }

  __device__ void meetBodies(bool places, int placement, int before, int hops) {
    if (!with_bodies) return;
    once([&] { here_.placement = placement; });
    if (!bodies_.displacement) return drag();
    const bool cast = (places || sandComesToBodiesApart()) && isMoved(placement - before);
    if (cast) {
      once([&] {
        here_.rests = false;
        here_.flows = true;
      });
    } else if (restsNow()) {
      return;
    }
    makeWay(hops, cast);
  }

 private:
  __device__ SandLayer state() const { return here_.flipped ? run_.next : run_.state; }
  __device__ SandLayer next() const { return here_.flipped ? run_.state : run_.next; }

  __device__ SandColumns columns() const {
    SandColumns columns = bodies_.columns;
    columns.visible = state();
    return columns;
  }

  __device__ StepArguments arguments() const {
    StepArguments step = run_.step;
    const SandLayer sand = state();
    step.in.depth = sand.depth;
    step.in.momentum_x = sand.momentum_x;
    step.in.momentum_y = sand.momentum_y;
    step.setTimeStep(here_.dt);
    return step;
  }

  template <bool near_bodies>
  __device__ float stepped(int tile) const {
    using LocalStep = Step<near_bodies, with_slopes>;
    return stepTile(StepCell<LocalStep>{LocalStep{arguments()}, next()}, tiles_, tile, here_.number);
  }

  __device__ void countOutflow() const {
    const OpenEdges& open = run_.step.open;
    if (!(open.x_min || open.x_max || open.y_min || open.y_max)) return;
    // Edge faces have no slopes.
    using EdgeStep = Step<with_bodies, false>;
    const CountOutflow<EdgeStep> count{EdgeStep{arguments()}, run_.left};
    const auto countAlong = [&](bool is_open, int begin, int cells) {
      if (!is_open) return;
      for (int k = static_cast<int>(team_.thread()); k < cells; k += static_cast<int>(team_.threads()))
        count(0, begin + k);
    };
    const int columns = run_.step.columns;
    const int rows = run_.step.rows;
    countAlong(open.y_min, 0, columns);
    countAlong(open.y_max, columns, columns);
    countAlong(open.x_min, 2 * columns, rows);
    countAlong(open.x_max, 2 * columns + rows, rows);
    team_.wait();
  }

  __device__ void flowLoads() {
    const FlowLoads flow{Step<true, false>{arguments()},
                         columns(),
                         bodies_.contact,
                         bodies_.bed,
                         bodies_.flowed,
                         next(),
                         bodies_.next_hidden};
    bool flowed = false;
    forEachCell([&](int i, int j, int) {
      flow(i, j);
      flowed = flowed || FlowedSand{flow}(i, j) > 0.0f;
    });
    const bool flows = team_.any(flowed ? 1 : 0) != 0;
    once([&] { here_.flows = flows; });
    if (!flows) return;
    forEachCell([&](int i, int j, int) {
      CopyLoads{flow}(i, j);
      if (bodies_.flowed[flow.step.index(i, j)] != 0) tiles_.touch(i, j, here_.number);
    });
    team_.wait();
  }

  __device__ void markTilesNearBodies() {
    for (int tile = static_cast<int>(team_.thread()); tile < tiles_.count;
         tile += static_cast<int>(team_.threads())) {
      const Window cells = tiles_.cellsOf(tile);
      const Window reached{cells.column_begin - DueTiles::kReach, cells.row_begin - DueTiles::kReach,
                           cells.column_end + DueTiles::kReach, cells.row_end + DueTiles::kReach};
      bool is_near = false;
      for (int w = 0; w < bodies_.window_count; ++w) {
        is_near = is_near || !reached.overlap(bodies_.windows[w].cells).empty();
      }
      tiles_.is_near[tile] = is_near ? 1 : 0;
      if (is_near && tiles_.isDue(tile, here_.number))
        atomicOr(&tiles_.crowded[DueTiles::listOf(here_.number)], 1);
    }
    team_.wait();
  }

  /// Calls function(i, j, window) for the cells of blocks, each by a thread.
  template <class Function>
  __device__ static void forEachCellOf(const CellBlock* blocks, int count, const Function& function) {
    for (int k = static_cast<int>(blockIdx.x); k < count; k += static_cast<int>(gridDim.x)) {
      const CellBlock& block = blocks[k];
      const int i = block.cells.column_begin + static_cast<int>(threadIdx.x);
      const int j = block.cells.row_begin + static_cast<int>(threadIdx.y);
      if (block.cells.holds(i, j)) function(i, j, block.window);
    }
  }
  template <class Function>
  __device__ void forEachCell(const Function& function) const {
    forEachCellOf(bodies_.blocks, bodies_.block_count, function);
  }
  template <class Function>
  __device__ void forEachWideCell(const Function& function) const {
    forEachCellOf(bodies_.wide_blocks, bodies_.wide_block_count, function);
  }

  __device__ const BodyReach* reaches() const {
    return bodies_.reaches + static_cast<long long>(here_.placement + 1) * bodies_.count;
  }

  /// Whether a body that a block looks at together may touch sand before bodies are placed again.
  __device__ bool isNearSand(const BodyReach& body) const {
    bool found = body.poured_on;
    const SandAbove above{columns(), body.height, run_.step.sand.film, run_.step.columns};
    for (int j = body.around.row_begin + static_cast<int>(threadIdx.y); j < body.around.row_end;
         j += kBlockRows) {
      for (int i = body.around.column_begin + static_cast<int>(threadIdx.x); i < body.around.column_end;
           i += kBlockColumns)
        found = found || above(i, j) > 0.0f;
    }
    return __syncthreads_or(found ? 1 : 0) != 0;
  }

  /// Decides which bodies are apart. Returns whether that is not what it was, or others have moved since so
  /// many placements.
  __device__ bool isMoved(int since) {
    bool changed = false;
    for (int body = static_cast<int>(blockIdx.x); body < bodies_.count; body += static_cast<int>(gridDim.x)) {
      const BodyReach& reach = reaches()[body];
      const unsigned char apart = isNearSand(reach) ? 0 : 1;
      if (threadIdx.x != 0 || threadIdx.y != 0) continue;
      const bool moved = apart == 0 && reach.still <= since;
      changed = changed || moved || bodies_.apart[body] != apart;
      bodies_.apart[body] = apart;
    }
    return team_.any(changed ? 1 : 0) != 0;
  }

  __device__ bool sandComesToBodiesApart() {
    bool comes = false;
    for (int body = static_cast<int>(blockIdx.x); body < bodies_.count; body += static_cast<int>(gridDim.x))
      comes = (bodies_.apart[body] != 0 && isNearSand(reaches()[body])) || comes;
    return team_.any(comes ? 1 : 0) != 0;
  }

  __device__ SandWithoutRoom sandWithoutRoom() const {
    return {bodies_.contact, columns(), run_.step.columns};
  }

  /// Where no body has moved: whether the sand has not, either.
  __device__ bool restsNow() {
    bool rests = here_.rests;
    if (tiles_.crowded[DueTiles::listOf(here_.number)] != 0 || here_.flows) {
      rests = false;
    } else if (!rests) {
      const SandWithoutRoom without_room = sandWithoutRoom();
      bool found = false;
      forEachCell([&](int i, int j, int) { found = found || without_room(i, j) > 0.0f; });
      rests = team_.any(found ? 1 : 0) == 0;
    }
    once([&] { here_.rests = rests; });
    return rests;
  }

  __device__ BodiesOverBed overBed(int window) const {
    const long long first_view = static_cast<long long>(here_.placement + 1) * bodies_.count;
    return bodies_.overBed(window, first_view, bodies_.apart, run_.step);
  }

  /// Calls function(k, window) for a column or row k of each window, each by a thread.
  template <class Function>
  __device__ void forEachLine(bool columns, const Function& function) const {
    for (int w = 0; w < bodies_.window_count; ++w) {
      const Window& window = bodies_.windows[w].cells;
      const int lines = columns ? window.columns() : window.rows();
      for (int k = static_cast<int>(team_.thread()); k < lines; k += static_cast<int>(team_.threads()))
        function(k, w);
    }
    team_.wait();
  }

  /// Sand goes on by a column in each of `hops`, unless all has gone before.
  /// @param cast whether some body has moved
  __device__ void makeWay(int hops, bool cast) {
    forEachCell([&](int i, int j, int) { tiles_.touch(i, j, here_.number); });
    for (int hop = 0; hop < hops; ++hop) {
      meet(hop, cast);
      measureDistances();
      const unsigned found = displace(hop > 0);
      if ((found & kPushed) != 0) layPushedSand();
      if ((found & kWithoutRoom) == 0) return;
    }
  }

  __device__ void meet(int hop, bool cast) const {
    forEachCell([&](int i, int j, int window) {
      const MeetBodies meet{overBed(window), columns(), bodies_.contact, next(), bodies_.next_hidden};
      if (hop > 0) {
        meet.again(i, j);
      } else if (cast) {
        meet(i, j, solidsAt(meet, i, j));
      } else {
        meet(i, j);
      }
    });
    team_.wait();
  }

  __device__ void measureDistances() const {
    const int across = run_.step.columns;
    forEachLine(true, [&](int k, int window) {
      DistanceAlongColumns{bodies_.contact.clearance, next().depth,
                           bodies_.distance,          across,
                           run_.step.sand.spacing,    bodies_.windows[window].cells}(0, k);
    });
    forEachLine(false, [&](int k, int window) {
      DistanceAlongRows{bodies_.distance, across, bodies_.windows[window].cells}(0, k);
    });
  }

  static constexpr unsigned kPushed = 1;       // sand was pushed to columns that no body covers
  static constexpr unsigned kWithoutRoom = 2;  // sand has to go on

  __device__ unsigned displace(bool again) {
    const SandWithoutRoom without_room = sandWithoutRoom();
    unsigned found = 0;
    forEachCell([&](int i, int j, int window) {
      const int across = run_.step.columns;
      DisplaceSand{
          bodies_.contact, bodies_.distance,        next(), bodies_.next_hidden,    bodies_.bed, columns(),
          bodies_.pushed,  bodies_.givenIn(window), across, run_.step.sand.spacing, again}(i, j);
      if (PushedDepth{bodies_.pushed.depth, across}(i, j) > 0.0f) found |= kPushed;
      if (without_room(i, j) > 0.0f) found |= kWithoutRoom;
    });
    const unsigned result = team_.any(found);
    addGiven();
    return result;
  }

  /// What bodies gave to sand that made way for them.
  __device__ void addGiven() const {
    forEachLine(false, [&](int k, int window) {
      AddGiven{bodies_.givenIn(window), bodies_.contact.body, bodies_.given_sums, run_.step.columns}(0, k);
    });
  }

  __device__ void layPushedSand() const {
    SandLayer from = bodies_.pushed;
    SandLayer to = next();
    const auto sand = [&](int window) {
      return PushedSand{
          columns(),         run_.step.in.repose_rise,    run_.step.sand, from, bodies_.next_hidden.depth,
          run_.step.columns, bodies_.wide_windows[window]};
    };
    for (int pass = 0; pass < kPassesOfPushedSand; ++pass) {
      forEachWideCell([&](int i, int j, int window) { DividePushedSand{sand(window)}(i, j); });
      team_.wait();
      forEachWideCell([&](int i, int j, int window) { LowerPushedSand{sand(window), to}(i, j); });
      team_.wait();
      const SandLayer lowered = to;
      to = from;
      from = lowered;
    }
    forEachWideCell([&](int i, int j, int) {
      LayPushedSand{columns(), bodies_.pushed, run_.step.columns}(i, j);
      tiles_.touch(i, j, here_.number);
    });
    team_.wait();
  }

  __device__ void drag() const {
    forEachCell([&](int i, int j, int window) {
      const FindSubmerged find{overBed(window), state().depth, bodies_.contact};
      find(i, j, solidsAt(find, i, j));
    });
    team_.wait();
    forEachCell([&](int i, int j, int window) {
      DragSand{bodies_.contact, state(), run_.step.columns, run_.step.sand.spacing, bodies_.givenIn(window)}(
          i, j);
      tiles_.touch(i, j, here_.number);
    });
    team_.wait();
    addGiven();
  }

  const GpuRun& run_;
  const BodiesOnGpu& bodies_;
  const DueTiles& tiles_;
  RunInBlock& here_;
  GridTeam team_;
  BlockMaximum block_maximum_;
};

}  // namespace shallow_sand
