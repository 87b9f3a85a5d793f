#pragma once

#include <vector>

#include "shallow_sand/device/host_executor.h"
#include "shallow_sand/solver/step.h"

namespace shallow_sand {

/// The step of a CPU: walks up the rows of a band, keeps each face for the two cells that share it, and lays
/// values out so that the compiler computes several cells at once. Calls the same functions as StepCell.
template <bool with_bodies>
class RowWalker {
 public:
  RowWalker(const Step<with_bodies>& step, const SandFieldsOut& out)
      : step_(step),
        out_(out),
        south_(step.columns),
        own_(step.columns),
        north_(step.columns),
        flux_south_(step.columns),
        flux_north_(step.columns),
        flux_x_(step.columns + 1) {}

  /// Steps the rows [begin, end).
  void walk(int begin, int end) {
    if (begin >= end) return;
    load(own_, begin);
    if (begin == 0) {
      southEdge();
    } else {
      load(south_, begin - 1);
      facesY(flux_south_, south_, own_);
    }
    for (int j = begin; j < end; ++j) {
      if (j == step_.rows - 1) {
        northEdge();
      } else {
        load(north_, j + 1);
        facesY(flux_north_, own_, north_);
      }
      facesX(j);
      updateRow(j);
      std::swap(south_, own_);
      std::swap(own_, north_);
      std::swap(flux_south_, flux_north_);
    }
  }

 private:
  // Rows hand out plain pointers: a loop that copies them, and the step, to the stack is one that compilers
  // vectorise.
  struct CellRow {
    explicit CellRow(int n) : columns(n), values(7 * static_cast<std::size_t>(n)), walls(n) {}
    struct View {
      float *h, *hu, *hv, *u, *v, *b, *room;
      int* closed;
      Cell get(int i) const {
        if (!with_bodies)
          return {h[i], hu[i], hv[i], u[i], v[i], b[i], std::numeric_limits<float>::infinity(), false};
        return {h[i], hu[i], hv[i], u[i], v[i], b[i], room[i], closed[i] != 0};
      }
      void set(int i, const Cell& cell) const {
        h[i] = cell.h;
        hu[i] = cell.hu;
        hv[i] = cell.hv;
        u[i] = cell.u;
        v[i] = cell.v;
        b[i] = cell.b;
        room[i] = cell.room;
        closed[i] = cell.closed ? 1 : 0;
      }
    };
    View view() {
      float* p = values.data();
      const int n = columns;
      return {p, p + n, p + 2 * n, p + 3 * n, p + 4 * n, p + 5 * n, p + 6 * n, walls.data()};
    }
    int columns;
    std::vector<float> values;
    std::vector<int> walls;
  };
  struct FluxRow {
    explicit FluxRow(int n) : columns(n), values(4 * static_cast<std::size_t>(n)) {}
    struct View {
      float *mass, *momentum_left, *momentum_right, *shear;
      FaceFlux get(int i) const { return {mass[i], momentum_left[i], momentum_right[i], shear[i]}; }
      void set(int i, const FaceFlux& flux) const {
        mass[i] = flux.mass;
        momentum_left[i] = flux.momentum_left;
        momentum_right[i] = flux.momentum_right;
        shear[i] = flux.shear;
      }
    };
    View view() {
      float* p = values.data();
      return {p, p + columns, p + 2 * columns, p + 3 * columns};
    }
    int columns;
    std::vector<float> values;
  };

  void load(CellRow& row, int j) const {
    const Step<with_bodies> step = step_;
    const typename CellRow::View cells = row.view();
    const long long start = step.index(0, j);
    const int n = step.columns;
#pragma omp simd
    for (int i = 0; i < n; ++i) cells.set(i, step.load(start + i));
  }

  void facesY(FluxRow& row, CellRow& south_row, CellRow& north_row) const {
    const Step<with_bodies> step = step_;
    const typename FluxRow::View flux = row.view();
    const typename CellRow::View south = south_row.view();
    const typename CellRow::View north = north_row.view();
    const int n = step.columns;
#pragma omp simd
    for (int i = 0; i < n; ++i) flux.set(i, step.template faceY<with_bodies>(south.get(i), north.get(i)));
  }

  void facesX(int j) {
    const Step<with_bodies> step = step_;
    const typename FluxRow::View flux = flux_x_.view();
    const typename CellRow::View own = own_.view();
    const int last = step.columns - 1;
    flux.set(0, step.westEdge(step.beyondWest(own.get(0), j), own.get(0)));
    flux.set(last + 1, step.eastEdge(own.get(last), step.beyondEast(own.get(last), j)));
#pragma omp simd
    for (int i = 1; i <= last; ++i) flux.set(i, step.template faceX<with_bodies>(own.get(i - 1), own.get(i)));
  }

  void southEdge() {
    const typename CellRow::View own = own_.view();
    for (int i = 0; i < step_.columns; ++i) {
      const Cell outside = step_.beyondSouth(own.get(i), i);
      south_.view().set(i, outside);
      flux_south_.view().set(i, step_.southEdge(outside, own.get(i)));
    }
  }

  void northEdge() {
    const typename CellRow::View own = own_.view();
    for (int i = 0; i < step_.columns; ++i) {
      const Cell outside = step_.beyondNorth(own.get(i), i);
      north_.view().set(i, outside);
      flux_north_.view().set(i, step_.northEdge(own.get(i), outside));
    }
  }

  void updateRow(int j) {
    const Step<with_bodies> step = step_;
    const SandFieldsOut out = out_;
    const typename CellRow::View own = own_.view();
    const typename CellRow::View south = south_.view();
    const typename CellRow::View north = north_.view();
    const typename FluxRow::View flux_x = flux_x_.view();
    const typename FluxRow::View flux_south = flux_south_.view();
    const typename FluxRow::View flux_north = flux_north_.view();
    const long long start = step.index(0, j);
    const auto update = [=](int i, const Cell& west, const Cell& east) {
      const Neighbours neighbours{west, east, south.get(i), north.get(i)};
      const CellFluxes fluxes{flux_x.get(i), flux_x.get(i + 1), flux_south.get(i), flux_north.get(i)};
      const CellUpdate next = step.update(own.get(i), neighbours, fluxes);
      out.depth[start + i] = next.h;
      out.momentum_x[start + i] = next.q.x;
      out.momentum_y[start + i] = next.q.y;
    };
    const int last = step.columns - 1;
    const Cell west = step.beyondWest(own.get(0), j);
    const Cell east = step.beyondEast(own.get(last), j);
    update(0, west, last > 0 ? own.get(1) : east);
#pragma omp simd
    for (int i = 1; i < last; ++i) update(i, own.get(i - 1), own.get(i + 1));
    if (last > 0) update(last, own.get(last - 1), east);
  }

  Step<with_bodies> step_;
  SandFieldsOut out_;
  CellRow south_;
  CellRow own_;
  CellRow north_;
  FluxRow flux_south_;
  FluxRow flux_north_;
  FluxRow flux_x_;
};

/// Steps the whole grid on the CPU, a band of rows for each thread.
template <bool with_bodies>
void stepGrid(HostExecutor& executor, const Step<with_bodies>& step, const SandFieldsOut& out) {
  executor.forEachBand(step.rows,
                       [&](int begin, int end) { RowWalker<with_bodies>(step, out).walk(begin, end); });
}

}  // namespace shallow_sand
