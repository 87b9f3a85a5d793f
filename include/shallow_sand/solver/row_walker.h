#pragma once

#include <algorithm>
#include <utility>

#include "shallow_sand/solver/step.h"
#include "shallow_sand/solver/tiles.h"

namespace shallow_sand {

/// The step of a CPU for a rectangle of cells: walks up its rows, keeps velocities, wave speeds and faces for
/// the cells that share them, and lays values out so that a compiler computes several cells at once. Calls
/// the same functions as StepCell, so the bits are the same.
template <class Step>
class RowWalker {
 public:
  /// Widest rectangle that is asked for [cells]; what its rows need leaves room in the first cache for those
  /// that are fetched ahead. The last tile of a row may make it wider by almost a tile.
  static constexpr int kWidest = 4 * Tiles::kColumns;
  static constexpr int kHighest = 8 * Tiles::kRows;
  /// Floats of scratch memory.
  static constexpr int scratchSize() { return kScratch; }

  /// @param cells whole tiles
  /// @param tiles gets what the step finds in each of them
  RowWalker(const Step& step, const SandFieldsOut& out, const Window& cells, Tiles& tiles, float* scratch)
      : step_(step),
        out_(out),
        cells_(cells),
        tiles_(tiles),
        column_(cells.column_begin),
        before_first_(std::min(kHalo, cells.column_begin)),
        loaded_(std::min(cells.column_end + kHalo, step.columns) - cells.column_begin),
        end_(cells.columns()) {
    const auto take = [&scratch](int arrays) {
      float* begin = scratch + kMargin;
      scratch += arrays * kStride;
      return begin;
    };
    uniform_ = take(3);
    std::fill_n(uniform_ - kMargin, kStride, step.sand.uniform.repose_rise);
    std::fill_n(uniform_ - kMargin + kStride, kStride, step.sand.uniform.layer_fraction);
    std::fill_n(uniform_ - kMargin + 2 * kStride, kStride, step.sand.uniform.layer_depth);
    for (Row* row : {&before_, &own_, &next_, &after_})
      *row = {take(10), uniform_, uniform_ + kStride, uniform_ + 2 * kStride};
    for (Fluxes* fluxes : {&flux_south_, &flux_north_, &flux_x_}) *fluxes = {take(4)};
    for (Row* row : {&west_, &east_}) *row = {take(10), uniform_, uniform_ + kStride, uniform_ + 2 * kStride};
    for (Fluxes* fluxes : {&west_flux_, &east_flux_}) *fluxes = {take(4)};
    result_ = take(3);
    speed_ = take(1);
    motion_ = take(1);
    std::fill_n(speed_, end_, 0.0f);
    std::fill_n(motion_, end_, 0.0f);
  }

  void walk() {
    const int begin = cells_.row_begin;
    if (atWest()) prepareEdge<true>(west_, west_flux_);
    if (atEast()) prepareEdge<false>(east_, east_flux_);
    if (Step::with_slopes) load(before_, begin - 2);
    load(own_, begin - 1);
    load(next_, begin);
    if (Step::with_slopes) load(after_, begin + 1);
    facesNorthOf(begin - 1);
    for (int j = begin; j < cells_.row_end; ++j) {
      climb();
      load(Step::with_slopes ? after_ : next_, Step::with_slopes ? j + 2 : j + 1);
      facesNorthOf(j);
      facesX(j);
      updateRow(j);
      report(j);
    }
  }

 private:
  static constexpr int kHalo = Step::with_slopes ? 2 : 1;
  static constexpr bool kWithRoom = Step::with_bodies || Step::with_slopes;
  static constexpr int kAhead = 3;  // rows
  /// Room before index 0 of every array; lengths are rounded up to whole vectors, the widest of which hold
  /// this many floats.
  static constexpr int kMargin = 16;
  static constexpr int kStride = kMargin + kWidest + Tiles::kColumns + 2 * kMargin;
  static constexpr int kScratch = (3 + 6 * 10 + 5 * 4 + 3 + 1 + 1) * kStride;

  static int wholeVectors(int count) { return (count + kMargin - 1) / kMargin * kMargin; }

  /// Cells of one row of the grid; their index counts from the first one to step.
  struct Row {
    float* values;
    const float* repose_rise;
    const float* layer_fraction;
    const float* layer_depth;

    Cell get(int k) const {
      return {values[k],
              values[k + kStride],
              values[k + 2 * kStride],
              values[k + 3 * kStride],
              values[k + 4 * kStride],
              values[k + 5 * kStride],
              values[k + 6 * kStride],
              values[k + 7 * kStride],
              values[k + 8 * kStride],
              kWithRoom ? values[k + 9 * kStride] : std::numeric_limits<float>::infinity(),
              {repose_rise[k], layer_fraction[k], layer_depth[k]}};
    }
    void set(int k, const Cell& cell) const {
      values[k] = cell.h;
      values[k + kStride] = cell.hu;
      values[k + 2 * kStride] = cell.hv;
      values[k + 3 * kStride] = cell.u;
      values[k + 4 * kStride] = cell.v;
      values[k + 5 * kStride] = cell.b;
      values[k + 6 * kStride] = cell.c;
      values[k + 7 * kStride] = cell.s;
      values[k + 8 * kStride] = cell.wet_surface;
      if (kWithRoom) values[k + 9 * kStride] = cell.room;
    }
  };

  /// Faces of a row, each with the index of the cell to its north or east.
  struct Fluxes {
    float* values;

    FaceFlux get(int k) const {
      return {values[k], values[k + kStride], values[k + (Step::with_bodies ? 2 : 1) * kStride],
              values[k + 3 * kStride]};
    }
    void set(int k, const FaceFlux& flux) const {
      values[k] = flux.mass;
      values[k + kStride] = flux.momentum_left;
      if (Step::with_bodies) values[k + 2 * kStride] = flux.momentum_right;
      values[k + 3 * kStride] = flux.shear;
    }
    /// A face at the edge of the grid: only the side within counts, so that one momentum is enough.
    void setEdge(int k, FaceFlux flux, float momentum_within) const {
      flux.momentum_left = momentum_within;
      flux.momentum_right = momentum_within;
      set(k, flux);
    }
  };

  /// Goes on to the next row.
  void climb() {
    const Row oldest = before_;
    before_ = own_;
    own_ = next_;
    next_ = Step::with_slopes ? after_ : oldest;
    after_ = Step::with_slopes ? oldest : after_;
    std::swap(flux_south_, flux_north_);
  }

  /// Where row j of a field will be read or written; the last row if there is none.
  const float* ahead(const float* field, int j) const {
    return field + step_.index(column_, std::min(j, step_.rows - 1));
  }

  /// Calls function(k) for k in [0, end), and asks the caches for two rows of fields that are needed soon:
  /// those of a rectangle are too short for the hardware to foresee.
  template <class Function>
  static void sweep(int end, const float* soon, const float* soon_too, const Function& function) {
    for (int k = 0; k < end; k += kMargin) {
      __builtin_prefetch(soon + k);
      __builtin_prefetch(soon_too + k);
    }
#pragma GCC ivdep
    for (int k = 0; k < end; ++k) function(k);
  }

  /// The row beyond the northern edge is made up; the one beyond the southern edge is, once the first row is
  /// there.
  void load(Row& row, int j) {
    if (j == step_.rows) beyondNorth(row);
    if (j < 0 || j >= step_.rows) return;
    const Step step = step_;
    const long long start = step.index(column_, j);
    if (step.in.repose_rise != nullptr) {
      row.repose_rise = step.in.repose_rise + start;
      row.layer_fraction = step.in.layer_fraction + start;
      row.layer_depth = step.in.layer_depth + start;
    }
    const Row cells = row;
    const float* __restrict depth = step.in.depth + start;
    const float* __restrict momentum_x = step.in.momentum_x + start;
    const float* __restrict momentum_y = step.in.momentum_y + start;
    const float* __restrict bed = step.in.bed + start;
    const float* __restrict ceiling = Step::with_bodies ? step.in.ceiling + start : nullptr;
    const auto compute = [=](int k) {
      const LocalMaterial material{cells.repose_rise[k], cells.layer_fraction[k], cells.layer_depth[k]};
      cells.set(k, step.cell(depth[k], momentum_x[k], momentum_y[k], bed[k],
                             Step::with_bodies ? ceiling[k] : 0.0f, material));
    };
    for (int k = -before_first_; k < 0; ++k) compute(k);
    sweep(wholeVectors(loaded_), ahead(step.in.depth, j + kAhead), ahead(step.in.bed, j + kAhead), compute);
  }

  /// Faces between row j, which is own_, and the next one.
  void facesNorthOf(int j) {
    if (j == -1) return southEdge();
    if (j == step_.rows - 1) return northEdge();
    const Step step = step_;
    const Row before = before_;
    const Row south = own_;
    const Row north = next_;
    const Row after = after_;
    const Fluxes flux = flux_north_;
    sweep(wholeVectors(end_), ahead(step.in.momentum_x, j + kAhead), ahead(step.in.momentum_y, j + kAhead),
          [=](int k) { flux.set(k, step.faceY(before.get(k), south.get(k), north.get(k), after.get(k))); });
  }

  void southEdge() {
    for (int k = -before_first_; k < loaded_; ++k) own_.set(k, step_.beyondSouth(next_.get(k), column_ + k));
    for (int k = 0; k < end_; ++k) {
      const Cell inside = next_.get(k);
      const FaceFlux flux = step_.southEdge(step_.beyondSouth(inside, column_ + k), inside);
      flux_north_.setEdge(k, flux, flux.momentum_right);
    }
  }

  void northEdge() {
    for (int k = 0; k < end_; ++k) {
      const Cell inside = own_.get(k);
      const FaceFlux flux = step_.northEdge(inside, step_.beyondNorth(inside, column_ + k));
      flux_north_.setEdge(k, flux, flux.momentum_left);
    }
  }

  /// Beyond the last row, which is the newest one but `row`.
  void beyondNorth(Row& row) {
    const Row last = Step::with_slopes ? next_ : own_;
    for (int k = -before_first_; k < loaded_; ++k) row.set(k, step_.beyondNorth(last.get(k), column_ + k));
  }

  /// All faces of row j that look east or west. Those at edges were computed before.
  void facesX(int j) {
    if (atWest()) own_.set(-1, west_.get(j - cells_.row_begin));
    if (atEast()) own_.set(end_, east_.get(j - cells_.row_begin));
    const Step step = step_;
    const Row own = own_;
    const Fluxes flux = flux_x_;
    sweep(wholeVectors(end_ + 1), ahead(out_.depth, j + 1), ahead(out_.momentum_x, j + 1), [=](int k) {
      const Cell west = own.get(k - 1);
      const Cell east = own.get(k);
      flux.set(k, step.faceX(Step::with_slopes ? own.get(k - 2) : west, west, east,
                             Step::with_slopes ? own.get(k + 1) : east));
    });
    if (atWest()) flux.set(0, west_flux_.get(j - cells_.row_begin));
    if (atEast()) flux.set(end_, east_flux_.get(j - cells_.row_begin));
  }

  bool atWest() const { return cells_.column_begin == 0; }
  bool atEast() const { return cells_.column_end == step_.columns; }

  /// What stands beyond the western or the eastern edge of the grid, and the faces there, for all rows at
  /// once.
  template <bool west>
  void prepareEdge(const Row& outside_rows, const Fluxes& edge_fluxes) const {
    const Step step = step_;
    const Row outside = outside_rows;
    const Fluxes flux = edge_fluxes;
    const int column = west ? 0 : step.columns - 1;
    const int begin = cells_.row_begin;
    const int rows = cells_.rows();
#pragma GCC ivdep
    for (int r = 0; r < rows; ++r) {
      const Cell own = step.load(step.index(column, begin + r));
      const Cell beyond = west ? step.beyondWest(own, begin + r) : step.beyondEast(own, begin + r);
      const FaceFlux edge = west ? step.westEdge(beyond, own) : step.eastEdge(own, beyond);
      outside.set(r, beyond);
      flux.setEdge(r, edge, west ? edge.momentum_right : edge.momentum_left);
    }
  }

  void updateRow(int j) {
    const Step step = step_;
    const Row own = own_;
    const Row south = before_;
    const Row north = next_;
    const Fluxes flux_x = flux_x_;
    const Fluxes flux_south = flux_south_;
    const Fluxes flux_north = flux_north_;
    // The loop runs on to whole vectors, and past its end lie cells of other rectangles.
    const bool in_place = wholeVectors(end_) == end_;
    const long long start = step.index(column_, j);
    float* const depth_out = in_place ? out_.depth + start : result_;
    float* const momentum_x_out = in_place ? out_.momentum_x + start : result_ + kStride;
    float* const momentum_y_out = in_place ? out_.momentum_y + start : result_ + 2 * kStride;
    float* const speed = speed_;
    float* const motion = motion_;
    const float* const momentum_x = step.in.momentum_x + start;
    const float* const momentum_y = step.in.momentum_y + start;
    const float* const soon = ahead(out_.momentum_y, j + 1);
    sweep(wholeVectors(end_), soon, soon, [=](int k) {
      const Cell cell = own.get(k);
      const Neighbours neighbours{own.get(k - 1), own.get(k + 1), south.get(k), north.get(k)};
      const CellFluxes fluxes{flux_x.get(k), flux_x.get(k + 1), flux_south.get(k), flux_north.get(k)};
      const CellUpdate next = step.update(cell, neighbours, fluxes);
      depth_out[k] = next.h;
      momentum_x_out[k] = next.q.x;
      momentum_y_out[k] = next.q.y;
      speed[k] = maximum(speed[k], step.signalSpeed(cell));
      const float crossing = (fabsf(fluxes.west.mass) + fabsf(fluxes.east.mass)) +
                             (fabsf(fluxes.south.mass) + fabsf(fluxes.north.mass));
      const float before = fabsf(momentum_x[k]) + fabsf(momentum_y[k]);
      motion[k] = maximum(motion[k], crossing + (before + (fabsf(next.q.x) + fabsf(next.q.y))));
    });
    if (in_place) return;
    std::copy_n(result_, end_, out_.depth + start);
    std::copy_n(result_ + kStride, end_, out_.momentum_x + start);
    std::copy_n(result_ + 2 * kStride, end_, out_.momentum_y + start);
  }

  /// Tells the tiles of row j what was found since the last call that did, when row j ends the southern, the
  /// middle or the northern part of their rows.
  void report(int j) {
    const int tile_row = tiles_.tileOfRow(j);
    const Window row = tiles_.cellsOf(0, tile_row);
    const int first = tiles_.tileOfColumn(column_);
    const int last = tiles_.tileOfColumn(cells_.column_end - 1);
    if (j == row.row_begin) {
      for (int column = first; column <= last; ++column) tiles_.activity(column, tile_row) = TileActivity{};
    }
    const bool southern = j == row.row_begin + Tiles::kReach - 1;
    const bool middle = j == row.row_end - Tiles::kReach - 1 && j >= row.row_begin + Tiles::kReach;
    const bool northern = j == row.row_end - 1;
    if (!southern && !middle && !northern) return;
    for (int column = first; column <= last; ++column) {
      const Window tile = tiles_.cellsOf(column, tile_row);
      add(tiles_.activity(column, tile_row), tile.column_begin - column_, tile.column_end - column_, southern,
          northern);
    }
    std::fill_n(motion_, end_, 0.0f);
    std::fill_n(speed_, end_, 0.0f);
  }

  void add(TileActivity& found, int begin, int end, bool southern, bool northern) const {
    const float* __restrict speed = speed_;
    const float* __restrict motion = motion_;
    float fastest = 0.0f;
    float moved = 0.0f;
#pragma omp simd reduction(max : fastest) reduction(+ : moved)
    for (int k = begin; k < end; ++k) {
      fastest = speed[k] > fastest ? speed[k] : fastest;
      moved += motion[k];
    }
    found.speed = maximum(found.speed, fastest);
    if (!(moved > 0.0f)) return;
    found.inside = true;
    found.south = found.south || southern;
    found.north = found.north || northern;
    const int reach = std::min(Tiles::kReach, end - begin);
    for (int k = 0; k < reach; ++k) {
      found.west = found.west || motion[begin + k] > 0.0f;
      found.east = found.east || motion[end - 1 - k] > 0.0f;
    }
  }

  Step step_;
  SandFieldsOut out_;
  Window cells_;
  Tiles& tiles_;
  int column_;        // of the grid, that of index 0
  int before_first_;  // cells with negative indices that are loaded
  int loaded_;        // past the last cell that is loaded
  int end_;           // past the last cell to step
  float* uniform_;    // three arrays
  Row before_, own_, next_, after_;
  Fluxes flux_south_, flux_north_, flux_x_;
  Row west_, east_;  // beyond the edges of the grid; these and their faces count rows from the first one
  Fluxes west_flux_, east_flux_;
  float* result_;  // of a row that does not end with a whole vector: h, hu, hv
  float* speed_;
  float* motion_;
};

}  // namespace shallow_sand
