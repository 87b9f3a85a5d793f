#pragma once

#include <limits>

#include "shallow_sand/device/window.h"
#include "shallow_sand/solver/equations.h"

namespace shallow_sand {

/// The fields that a step reads, on the memory of their backend.
struct SandFields {
  const float* depth;       ///< h [m]
  const float* momentum_x;  ///< hu [m²/s]
  const float* momentum_y;  ///< hv [m²/s]
  const float* bed;         ///< b [m]
  const float* ceiling;     ///< depth for which there is room under a body, infinite where there is none [m]
};

/// The fields that a step writes.
struct SandFieldsOut {
  float* depth;
  float* momentum_x;
  float* momentum_y;
};

/// Which of the four edges are open; a wall otherwise.
struct OpenEdges {
  bool x_min;
  bool x_max;
  bool y_min;
  bool y_max;
};

/// A cell as its faces see it.
struct Cell {
  float h;
  float hu;
  float hv;
  float u;
  float v;
  float b;
  float room;   ///< depth that still fits under a body [m]
  bool closed;  ///< a wall to its neighbours: full up to a body, or beyond a walled edge
};

/// The fluxes through the four faces of a cell.
struct CellFluxes {
  FaceFlux west;
  FaceFlux east;
  FaceFlux south;
  FaceFlux north;
};

/// A cell's four neighbours.
struct Neighbours {
  Cell west;
  Cell east;
  Cell south;
  Cell north;
};

/// What is new in a cell.
struct CellUpdate {
  float h;
  Momentum q;
};

/// A step (Eq. 8–10) as pure functions of cells and faces; all read the state at time t only. A backend may
/// compute every face twice or keep it: the bits are the same. `with_bodies` is false where no body is near
/// the sand; `in.ceiling` is read only where it is true.
template <bool with_bodies>
struct Step {
  SandFields in;
  SandConstants sand;
  OpenEdges open;
  int columns;
  int rows;
  float dt;    ///< Δt [s]
  float rate;  ///< ΔL/Δt [m/s]

  SHALLOW_SAND_HOST_DEVICE long long index(int i, int j) const {
    return static_cast<long long>(j) * columns + i;
  }

  SHALLOW_SAND_HOST_DEVICE Cell load(long long at) const {
    Cell cell;
    cell.h = in.depth[at];
    cell.b = in.bed[at];
    const float hu = in.momentum_x[at];
    const float hv = in.momentum_y[at];
    const float inverse = inverseDepth(cell.h, sand);
    cell.u = inverse * hu;
    cell.v = inverse * hv;
    // Where Eq. 13 damps the velocity, the momentum follows it (section 4.1).
    const bool thin = (cell.h * cell.h) * (cell.h * cell.h) < sand.epsilon;
    cell.hu = thin ? cell.h * cell.u : hu;
    cell.hv = thin ? cell.h * cell.v : hv;
    cell.room = std::numeric_limits<float>::infinity();
    cell.closed = false;
    if (with_bodies) {
      const float ceiling = in.ceiling[at];
      cell.room = maximum(ceiling - cell.h, 0.0f);
      cell.closed = isFull(cell.h, ceiling, sand.spacing);
    }
    return cell;
  }

  /// What stands beyond an edge. Where it is open, sand as deep and as fast, on a bed that goes on as it came
  /// from the next cell inwards. Where it is not, or where sand moves away from it, for nothing comes in: a
  /// wall, before which the bed rises like a level surface does in tilted gravity.
  SHALLOW_SAND_HOST_DEVICE static Cell beyond(Cell own, bool flows_on, float inner_bed, float level_rise) {
    own.b = flows_on ? own.b + (own.b - inner_bed) : own.b + level_rise;
    own.closed = !flows_on;
    return own;
  }
  SHALLOW_SAND_HOST_DEVICE Cell beyondWest(const Cell& own, int j) const {
    return beyond(own, open.x_min && own.u <= 0.0f, in.bed[index(columns > 1 ? 1 : 0, j)], -sand.level_x);
  }
  SHALLOW_SAND_HOST_DEVICE Cell beyondEast(const Cell& own, int j) const {
    return beyond(own, open.x_max && own.u >= 0.0f, in.bed[index(columns > 1 ? columns - 2 : 0, j)],
                  sand.level_x);
  }
  SHALLOW_SAND_HOST_DEVICE Cell beyondSouth(const Cell& own, int i) const {
    return beyond(own, open.y_min && own.v <= 0.0f, in.bed[index(i, rows > 1 ? 1 : 0)], -sand.level_y);
  }
  SHALLOW_SAND_HOST_DEVICE Cell beyondNorth(const Cell& own, int i) const {
    return beyond(own, open.y_max && own.v >= 0.0f, in.bed[index(i, rows > 1 ? rows - 2 : 0)], sand.level_y);
  }

  SHALLOW_SAND_HOST_DEVICE Neighbours neighbours(const Cell& own, int i, int j) const {
    const long long at = index(i, j);
    return {i == 0 ? beyondWest(own, j) : load(at - 1), i == columns - 1 ? beyondEast(own, j) : load(at + 1),
            j == 0 ? beyondSouth(own, i) : load(at - columns),
            j == rows - 1 ? beyondNorth(own, i) : load(at + columns)};
  }

  /// Whether a cell is a wall to a neighbour: closed, or under a body whose underside lies lower than the
  /// neighbour's surface, so that the sand that could flow meets the body's side. A gap under a body lets
  /// sand in only from below.
  SHALLOW_SAND_HOST_DEVICE static bool isWall(const Cell& cell, const Cell& neighbour) {
    return cell.closed || (with_bodies && neighbour.h + neighbour.b > (cell.h + cell.b) + cell.room);
  }

  /// Flux between two cells, each of which may be a wall to the other.
  template <bool may_be_closed>
  SHALLOW_SAND_HOST_DEVICE FaceFlux face(const FaceSide& left, const FaceSide& right, const Cell& left_cell,
                                         const Cell& right_cell, float level_rise) const {
    FaceFlux flux = faceFlux(left, right, level_rise, sand);
    flux.mass = limitMassFlux(flux.mass, minimum(left_cell.h, right_cell.room),
                              minimum(right_cell.h, left_cell.room), rate);
    if (may_be_closed) {
      const bool wall = isWall(left_cell, right_cell) || isWall(right_cell, left_cell);
      flux.mass = wall ? 0.0f : flux.mass;
      flux.shear = wall ? 0.0f : flux.shear;
      flux.momentum_left = wall ? wallMomentum(left.h, left.u, sand) : flux.momentum_left;
      flux.momentum_right = wall ? wallMomentum(right.h, -right.u, sand) : flux.momentum_right;
    }
    return flux;
  }

  template <bool may_be_closed>
  SHALLOW_SAND_HOST_DEVICE FaceFlux faceX(const Cell& west, const Cell& east) const {
    return face<may_be_closed>({west.h, west.u, west.v, west.b}, {east.h, east.u, east.v, east.b}, west, east,
                               sand.level_x);
  }
  template <bool may_be_closed>
  SHALLOW_SAND_HOST_DEVICE FaceFlux faceY(const Cell& south, const Cell& north) const {
    return face<may_be_closed>({south.h, south.v, south.u, south.b}, {north.h, north.v, north.u, north.b},
                               south, north, sand.level_y);
  }

  /// Faces at the edges of the grid; through an open edge sand only leaves.
  SHALLOW_SAND_HOST_DEVICE FaceFlux westEdge(const Cell& outside, const Cell& own) const {
    FaceFlux flux = faceX<true>(outside, own);
    flux.mass = minimum(flux.mass, 0.0f);
    return flux;
  }
  SHALLOW_SAND_HOST_DEVICE FaceFlux eastEdge(const Cell& own, const Cell& outside) const {
    FaceFlux flux = faceX<true>(own, outside);
    flux.mass = maximum(flux.mass, 0.0f);
    return flux;
  }
  SHALLOW_SAND_HOST_DEVICE FaceFlux southEdge(const Cell& outside, const Cell& own) const {
    FaceFlux flux = faceY<true>(outside, own);
    flux.mass = minimum(flux.mass, 0.0f);
    return flux;
  }
  SHALLOW_SAND_HOST_DEVICE FaceFlux northEdge(const Cell& own, const Cell& outside) const {
    FaceFlux flux = faceY<true>(own, outside);
    flux.mass = maximum(flux.mass, 0.0f);
    return flux;
  }

  SHALLOW_SAND_HOST_DEVICE CellFluxes fluxes(const Cell& own, const Neighbours& n, int i, int j) const {
    return {i == 0 ? westEdge(n.west, own) : faceX<with_bodies>(n.west, own),
            i == columns - 1 ? eastEdge(own, n.east) : faceX<with_bodies>(own, n.east),
            j == 0 ? southEdge(n.south, own) : faceY<with_bodies>(n.south, own),
            j == rows - 1 ? northEdge(own, n.north) : faceY<with_bodies>(own, n.north)};
  }

  /// Surface of a neighbour as the pressure sees it; a wall is level with us.
  SHALLOW_SAND_HOST_DEVICE float surfaceOf(const Cell& neighbour, const Cell& own, float level_rise) const {
    const float own_surface = own.h + own.b;
    const float surface = pressureSurface(neighbour.h, neighbour.b, own_surface, level_rise);
    const bool wall = with_bodies && (isWall(neighbour, own) || isWall(own, neighbour));
    return wall ? own.h + (own.b + level_rise) : surface;
  }

  /// Advection (Eq. 8), pressure (Eq. 9, 17) and friction (Eq. 10, 19). A closed cell keeps its depth and
  /// loses its momentum.
  SHALLOW_SAND_HOST_DEVICE CellUpdate update(const Cell& own, const Neighbours& n,
                                             const CellFluxes& f) const {
    const float per_length = dt / sand.spacing;
    const float h = own.h - per_length * ((f.east.mass - f.west.mass) + (f.north.mass - f.south.mass));
    Momentum q;
    q.x = own.hu -
          per_length * ((f.east.momentum_left - f.west.momentum_right) + (f.north.shear - f.south.shear));
    q.y = own.hv -
          per_length * ((f.north.momentum_left - f.south.momentum_right) + (f.east.shear - f.west.shear));

    const float layer = diluteLayer(own.h, sand);
    const float rise_x = surfaceOf(n.east, own, sand.level_x) - surfaceOf(n.west, own, -sand.level_x);
    const float rise_y = surfaceOf(n.north, own, sand.level_y) - surfaceOf(n.south, own, -sand.level_y);
    const float half = 0.5f * sand.gravity / sand.spacing;
    q.x = q.x + (dt * layer) * (sand.gravity_x - half * rise_x);
    q.y = q.y + (dt * layer) * (sand.gravity_y - half * rise_y);
    q = applyFriction(q, layer, dt, sand);

    const bool moves = h > 0.0f && !(with_bodies && own.closed);
    return {with_bodies && own.closed ? own.h : h, {moves ? q.x : 0.0f, moves ? q.y : 0.0f}};
  }
};

/// Steps one cell, computing all that it needs.
template <bool with_bodies>
struct StepCell {
  Step<with_bodies> step;
  SandFieldsOut out;

  SHALLOW_SAND_HOST_DEVICE void operator()(int i, int j) const {
    const long long at = step.index(i, j);
    const Cell own = step.load(at);
    const Neighbours n = step.neighbours(own, i, j);
    const CellUpdate next = step.update(own, n, step.fluxes(own, n, i, j));
    out.depth[at] = next.h;
    out.momentum_x[at] = next.q.x;
    out.momentum_y[at] = next.q.y;
  }
};

/// Steps the whole grid, cell by cell.
template <class Executor, bool with_bodies>
void stepGrid(Executor& executor, const Step<with_bodies>& step, const SandFieldsOut& out) {
  executor.forEachCell(Window{0, 0, step.columns, step.rows}, StepCell<with_bodies>{step, out});
}

/// Adds to `left`, one double for each cell of the perimeter, the depth that leaves it through open edges in
/// a step. Calls (0, k): k counts the cells of the southern row, the northern row, the western and the
/// eastern column.
template <bool with_bodies>
struct CountOutflow {
  Step<with_bodies> step;
  double* left;  ///< 2·columns + 2·rows depths [m]

  SHALLOW_SAND_HOST_DEVICE void operator()(int, int k) const {
    const int columns = step.columns;
    const int rows = step.rows;
    const bool along_x = k < 2 * columns;
    const int side = along_x ? k / columns : 2 + (k - 2 * columns) / rows;
    const int along = along_x ? k % columns : (k - 2 * columns) % rows;
    const int i = side < 2 ? along : (side == 2 ? 0 : columns - 1);
    const int j = side < 2 ? (side == 0 ? 0 : rows - 1) : along;
    const Cell own = step.load(step.index(i, j));
    const Neighbours n = step.neighbours(own, i, j);
    float out = 0.0f;
    if (side == 0) out = -step.southEdge(n.south, own).mass;
    if (side == 1) out = step.northEdge(own, n.north).mass;
    if (side == 2) out = -step.westEdge(n.west, own).mass;
    if (side == 3) out = step.eastEdge(own, n.east).mass;
    left[k] += static_cast<double>(step.dt / step.sand.spacing * out);
  }
};

/// Largest |u| + c or |v| + c of a cell that holds sand (Eq. 14, 34). [m/s]
template <bool with_bodies>
struct SignalSpeed {
  Step<with_bodies> step;

  SHALLOW_SAND_HOST_DEVICE float operator()(int i, int j) const {
    const Cell cell = step.load(step.index(i, j));
    const float speed = maximum(fabsf(cell.u), fabsf(cell.v)) + waveSpeed(cell.h, step.sand);
    return cell.h > 0.0f && !cell.closed ? speed : 0.0f;
  }
};

}  // namespace shallow_sand
