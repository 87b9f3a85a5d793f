#pragma once

#include <array>
#include <limits>

#include "shallow_sand/device/window.h"
#include "shallow_sand/solver/equations.h"

namespace shallow_sand {

/// The fields that a step reads, on the memory of their backend.
struct SandFields {
  const float* depth;        ///< h [m]
  const float* momentum_x;   ///< hu [m²/s]
  const float* momentum_y;   ///< hv [m²/s]
  const float* bed;          ///< b [m]
  const float* ceiling;      ///< depth for which there is room under a body, infinite without one [m]
  const float* repose_rise;  ///< μ ΔL [m]; these three are null where the material is the same everywhere
  const float* layer_fraction;  ///< of layer(h)
  const float* layer_depth;     ///< h̄ of layer(h) [m]
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
  float c;            ///< speed of waves [m/s]
  float s;            ///< surface, h + b [m]
  float wet_surface;  ///< s where there is sand that can flow, below everything elsewhere [m]
  float room;  ///< depth that still fits under a body [m]; kClosed where the cell is a wall to its neighbours
  LocalMaterial material;
};

/// Room of a cell that is full up to a body, or beyond a walled edge.
constexpr float kClosed = -1.0f;

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

/// Everything that a step works on.
struct StepArguments {
  SandFields in;
  SandConstants sand;
  OpenEdges open;
  int columns;
  int rows;
  float dt;          ///< Δt [s]
  float per_time;    ///< 1/Δt [1/s]
  float rate;        ///< ΔL/Δt [m/s]
  float per_length;  ///< Δt/ΔL [s/m]

  /// Sets Δt [s] and what follows from it; `sand` must be there already.
  SHALLOW_SAND_HOST_DEVICE void setTimeStep(float seconds) {
    dt = seconds;
    per_time = 1.0f / dt;
    rate = sand.spacing / dt;
    per_length = dt / sand.spacing;
  }
};

/// A step (Eq. 8–10) as pure functions of cells and faces; all read the state at time t only. A backend may
/// compute every face twice or keep it: the bits are the same. `with_bodies` is false where no body is near
/// the sand; `in.ceiling` is read only where it is true. `with_slopes`: minmod reconstruction.
template <bool with_bodies_, bool with_slopes_>
struct Step : StepArguments {
  static constexpr bool with_bodies = with_bodies_;
  static constexpr bool with_slopes = with_slopes_;

  SHALLOW_SAND_HOST_DEVICE long long index(int i, int j) const {
    return static_cast<long long>(j) * columns + i;
  }

  SHALLOW_SAND_HOST_DEVICE LocalMaterial materialAt(long long at) const {
    if (in.repose_rise == nullptr) return sand.uniform;
    return {in.repose_rise[at], in.layer_fraction[at], in.layer_depth[at]};
  }

  SHALLOW_SAND_HOST_DEVICE Cell load(long long at) const {
    return cell(in.depth[at], in.momentum_x[at], in.momentum_y[at], in.bed[at],
                with_bodies ? in.ceiling[at] : 0.0f, materialAt(at));
  }

  SHALLOW_SAND_HOST_DEVICE Cell cell(float h, float hu, float hv, float b, float ceiling,
                                     const LocalMaterial& material) const {
    Cell cell;
    cell.h = h;
    cell.b = b;
    cell.s = h + b;
    cell.wet_surface = h > sand.film ? cell.s : -std::numeric_limits<float>::max();
    const float inverse = inverseDepth(h, sand);
    cell.u = inverse * hu;
    cell.v = inverse * hv;
    // Where Eq. 13 damps the velocity, the momentum follows it (section 4.1).
    const bool thin = (h * h) * (h * h) < sand.epsilon;
    cell.hu = thin ? h * cell.u : hu;
    cell.hv = thin ? h * cell.v : hv;
    cell.material = material;
    cell.c = waveSpeed(diluteLayer(h, material), sand);
    cell.room = std::numeric_limits<float>::infinity();
    if (with_bodies) {
      cell.room = isFull(h, ceiling, sand.spacing) ? kClosed : maximum(ceiling - h, 0.0f);
    }
    return cell;
  }

  /// What stands beyond an edge. Where it is open, sand as deep and as fast, on a bed that goes on as it came
  /// from the next cell inwards. Where it is not, or where sand moves away from it, for nothing comes in: a
  /// wall, before which the bed rises like a level surface does in tilted gravity.
  SHALLOW_SAND_HOST_DEVICE static Cell beyond(Cell own, bool flows_on, float inner_bed, float level_rise) {
    own.b = flows_on ? own.b + (own.b - inner_bed) : own.b + level_rise;
    own.s = own.h + own.b;
    own.wet_surface = own.h > 0.0f ? own.s : own.wet_surface;
    own.room = flows_on ? own.room : kClosed;
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
  /// neighbour's surface, so that the sand that could flow meets the body's side. A gap that is lower than a
  /// cell lets sand in only from below: blades would leak.
  SHALLOW_SAND_HOST_DEVICE bool isWall(const Cell& cell, const Cell& neighbour) const {
    const bool low = with_bodies && cell.room < sand.spacing && neighbour.s > cell.s + cell.room;
    return cell.room < 0.0f || low;
  }

  /// Surface of a neighbour as the pressure sees it (Eq. 17): a wall is level with us, and so is a dry
  /// neighbour whose bed stands above our surface. [m]
  SHALLOW_SAND_HOST_DEVICE float surfaceOf(const Cell& neighbour, const Cell& own, float level_rise) const {
    const float level = own.s + level_rise;
    const float surface = maximum(minimum(neighbour.s, level), neighbour.wet_surface);
    const bool wall = with_bodies && (isWall(neighbour, own) || isWall(own, neighbour));
    return wall ? own.h + (own.b + level_rise) : surface;
  }

  /// A cell as it is at its centre, along x and along y.
  SHALLOW_SAND_HOST_DEVICE static FaceSide centreX(const Cell& cell) {
    return {cell.h, cell.u, cell.v, cell.b, cell.c, cell.material.repose_rise};
  }
  SHALLOW_SAND_HOST_DEVICE static FaceSide centreY(const Cell& cell) {
    return {cell.h, cell.v, cell.u, cell.b, cell.c, cell.material.repose_rise};
  }

  /// A cell at one of its faces: s, u and v go on from its centre with minmod slopes, the bed too, but so
  /// that the depth is not negative. Elevations are measured from a level surface.
  /// @param half 0.5 at the face towards `after`, -0.5 at the one towards `before`
  /// @param rise_before, rise_after of the surface, from each neighbour to the cell and on [m]
  SHALLOW_SAND_HOST_DEVICE FaceSide sloped(const FaceSide& before, const FaceSide& own, const FaceSide& after,
                                           float rise_before, float rise_after, float level_rise, float half,
                                           const LocalMaterial& material) const {
    const float ds = minmod(rise_before, rise_after);
    const float db = minmod(own.b - (before.b + level_rise), (after.b - level_rise) - own.b);
    const float dh = maximum(minimum(ds - db, 2.0f * own.h), -2.0f * own.h);
    FaceSide side;
    side.h = own.h + half * dh;
    side.b = own.b + half * (ds - dh);
    side.u = own.u + half * minmod(own.u - before.u, after.u - own.u);
    side.v = own.v + half * minmod(own.v - before.v, after.v - own.v);
    side.c = waveSpeed(diluteLayer(side.h, material), sand);
    side.repose_rise = own.repose_rise;
    return side;
  }

  /// A cell at one of its faces, along x and along y. Beside a wall it has no slopes.
  SHALLOW_SAND_HOST_DEVICE FaceSide sideX(const Cell& west, const Cell& own, const Cell& east,
                                          float half) const {
    if (!with_slopes) return centreX(own);
    const FaceSide side =
        sloped(centreX(west), centreX(own), centreX(east),
               (own.s - sand.level_x) - surfaceOf(west, own, -sand.level_x),
               surfaceOf(east, own, sand.level_x) - (own.s + sand.level_x), sand.level_x, half, own.material);
    return chosen(west.room < 0.0f || east.room < 0.0f, centreX(own), side);
  }
  SHALLOW_SAND_HOST_DEVICE FaceSide sideY(const Cell& south, const Cell& own, const Cell& north,
                                          float half) const {
    if (!with_slopes) return centreY(own);
    const FaceSide side = sloped(centreY(south), centreY(own), centreY(north),
                                 (own.s - sand.level_y) - surfaceOf(south, own, -sand.level_y),
                                 surfaceOf(north, own, sand.level_y) - (own.s + sand.level_y), sand.level_y,
                                 half, own.material);
    return chosen(south.room < 0.0f || north.room < 0.0f, centreY(own), side);
  }
  /// Member by member: of whole structs, compilers choose by a jump.
  SHALLOW_SAND_HOST_DEVICE static FaceSide chosen(bool first, const FaceSide& a, const FaceSide& b) {
    return {first ? a.h : b.h, first ? a.u : b.u, first ? a.v : b.v,
            first ? a.b : b.b, first ? a.c : b.c, a.repose_rise};
  }

  /// Flux between two cells, each of which may be a wall to the other.
  template <bool may_be_closed>
  SHALLOW_SAND_HOST_DEVICE FaceFlux face(const FaceSide& left, const FaceSide& right, const Cell& left_cell,
                                         const Cell& right_cell, float level_rise) const {
    FaceFlux flux = faceFlux(left, right, level_rise);
    flux.mass = limitMassFlux(flux.mass, minimum(left_cell.h, right_cell.room),
                              minimum(right_cell.h, left_cell.room), rate);
    if (may_be_closed) {
      const bool wall = isWall(left_cell, right_cell) || isWall(right_cell, left_cell);
      flux.mass = wall ? 0.0f : flux.mass;
      flux.shear = wall ? 0.0f : flux.shear;
      flux.momentum_left = wall ? wallMomentum(left, left.u) : flux.momentum_left;
      flux.momentum_right = wall ? wallMomentum(right, -right.u) : flux.momentum_right;
    }
    return flux;
  }

  /// The face between two cells, and their neighbours on the far sides, which only slopes need.
  SHALLOW_SAND_HOST_DEVICE FaceFlux faceX(const Cell& before, const Cell& west, const Cell& east,
                                          const Cell& after) const {
    return face<with_bodies>(sideX(before, west, east, 0.5f), sideX(west, east, after, -0.5f), west, east,
                             sand.level_x);
  }
  SHALLOW_SAND_HOST_DEVICE FaceFlux faceY(const Cell& before, const Cell& south, const Cell& north,
                                          const Cell& after) const {
    return face<with_bodies>(sideY(before, south, north, 0.5f), sideY(south, north, after, -0.5f), south,
                             north, sand.level_y);
  }

  /// Faces at the edges of the grid; through an open edge sand only leaves.
  SHALLOW_SAND_HOST_DEVICE FaceFlux westEdge(const Cell& outside, const Cell& own) const {
    FaceFlux flux = face<true>(centreX(outside), centreX(own), outside, own, sand.level_x);
    flux.mass = minimum(flux.mass, 0.0f);
    return flux;
  }
  SHALLOW_SAND_HOST_DEVICE FaceFlux eastEdge(const Cell& own, const Cell& outside) const {
    FaceFlux flux = face<true>(centreX(own), centreX(outside), own, outside, sand.level_x);
    flux.mass = maximum(flux.mass, 0.0f);
    return flux;
  }
  SHALLOW_SAND_HOST_DEVICE FaceFlux southEdge(const Cell& outside, const Cell& own) const {
    FaceFlux flux = face<true>(centreY(outside), centreY(own), outside, own, sand.level_y);
    flux.mass = minimum(flux.mass, 0.0f);
    return flux;
  }
  SHALLOW_SAND_HOST_DEVICE FaceFlux northEdge(const Cell& own, const Cell& outside) const {
    FaceFlux flux = face<true>(centreY(own), centreY(outside), own, outside, sand.level_y);
    flux.mass = maximum(flux.mass, 0.0f);
    return flux;
  }

  /// The neighbours of a cell's neighbours; without slopes nobody looks at them.
  SHALLOW_SAND_HOST_DEVICE Neighbours farNeighbours(const Cell& own, const Neighbours& n, int i,
                                                    int j) const {
    if (!with_slopes) return {own, own, own, own};
    const long long at = index(i, j);
    return {i > 1 ? load(at - 2) : beyondWest(n.west, j),
            i < columns - 2 ? load(at + 2) : beyondEast(n.east, j),
            j > 1 ? load(at - 2LL * columns) : beyondSouth(n.south, i),
            j < rows - 2 ? load(at + 2LL * columns) : beyondNorth(n.north, i)};
  }

  SHALLOW_SAND_HOST_DEVICE CellFluxes fluxes(const Cell& own, const Neighbours& n, int i, int j) const {
    const Neighbours far = farNeighbours(own, n, i, j);
    return {i == 0 ? westEdge(n.west, own) : faceX(far.west, n.west, own, n.east),
            i == columns - 1 ? eastEdge(own, n.east) : faceX(n.west, own, n.east, far.east),
            j == 0 ? southEdge(n.south, own) : faceY(far.south, n.south, own, n.north),
            j == rows - 1 ? northEdge(own, n.north) : faceY(n.south, own, n.north, far.north)};
  }

  /// Advection (Eq. 8), pressure (Eq. 9, 17) and friction (Eq. 10, 19). A closed cell keeps its depth and
  /// loses its momentum; a film has none.
  SHALLOW_SAND_HOST_DEVICE CellUpdate update(const Cell& own, const Neighbours& n,
                                             const CellFluxes& f) const {
    const float h = own.h - per_length * ((f.east.mass - f.west.mass) + (f.north.mass - f.south.mass));
    const float inverse_spacing = 1.0f / sand.spacing;
    const float layer = diluteLayer(own.h, own.material);
    const float rise_x = surfaceOf(n.east, own, sand.level_x) - surfaceOf(n.west, own, -sand.level_x);
    const float rise_y = surfaceOf(n.north, own, sand.level_y) - surfaceOf(n.south, own, -sand.level_y);
    const float half = 0.5f * sand.gravity * inverse_spacing;
    Momentum change;  // a second
    change.x =
        layer * (sand.gravity_x - half * rise_x) -
        inverse_spacing * ((f.east.momentum_left - f.west.momentum_right) + (f.north.shear - f.south.shear));
    change.y =
        layer * (sand.gravity_y - half * rise_y) -
        inverse_spacing * ((f.north.momentum_left - f.south.momentum_right) + (f.east.shear - f.west.shear));
    const Momentum q{own.hu + dt * change.x, own.hv + dt * change.y};
    const Momentum rate{own.hu * per_time + change.x, own.hv * per_time + change.y};
    const Momentum rubbed = applyFriction(q, rate, layer, own.material.repose_rise, sand);

    const bool closed = with_bodies && own.room < 0.0f;
    const bool moves = h > sand.film && !closed;
    return {closed ? own.h : h, {moves ? rubbed.x : 0.0f, moves ? rubbed.y : 0.0f}};
  }

  /// |u| + c or |v| + c of a cell that holds sand, whichever is larger (Eq. 14, 34). [m/s]
  SHALLOW_SAND_HOST_DEVICE static float signalSpeed(const Cell& cell) {
    const float speed = maximum(fabsf(cell.u), fabsf(cell.v)) + cell.c;
    return with_bodies && cell.room < 0.0f ? 0.0f : speed;
  }
};

/// What a step finds in a cell.
struct CellActivity {
  float speed;  ///< signal speed before the step [m/s]
  bool moves;   ///< see TileActivity
};

/// Steps one cell, computing all that it needs.
template <class Step>
struct StepCell {
  Step step;
  SandFieldsOut out;

  /// Returns its signal speed before the step. [m/s]
  SHALLOW_SAND_HOST_DEVICE float operator()(int i, int j) const { return stepped(i, j).speed; }

  SHALLOW_SAND_HOST_DEVICE CellActivity stepped(int i, int j) const {
    const long long at = step.index(i, j);
    const Cell own = step.load(at);
    const Neighbours n = step.neighbours(own, i, j);
    const CellFluxes fluxes = step.fluxes(own, n, i, j);
    const CellUpdate next = step.update(own, n, fluxes);
    out.depth[at] = next.h;
    out.momentum_x[at] = next.q.x;
    out.momentum_y[at] = next.q.y;
    const float crossing = (fabsf(fluxes.west.mass) + fabsf(fluxes.east.mass)) +
                           (fabsf(fluxes.south.mass) + fabsf(fluxes.north.mass));
    const float before = fabsf(step.in.momentum_x[at]) + fabsf(step.in.momentum_y[at]);
    const float after = fabsf(next.q.x) + fabsf(next.q.y);
    return {step.signalSpeed(own), crossing + (before + after) > 0.0f};
  }
};

/// Adds to `left`, one double for each cell of the perimeter, the depth that leaves it through open edges in
/// a step. Calls (0, k): k counts the cells of the southern row, the northern row, the western and the
/// eastern column (see perimeterOf).
template <class Step>
struct CountOutflow {
  Step step;
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
    float out = 0.0f;
    if (side == 0) out = -step.southEdge(step.beyondSouth(own, i), own).mass;
    if (side == 1) out = step.northEdge(own, step.beyondNorth(own, i)).mass;
    if (side == 2) out = -step.westEdge(step.beyondWest(own, j), own).mass;
    if (side == 3) out = step.eastEdge(own, step.beyondEast(own, j)).mass;
    left[k] += static_cast<double>(step.per_length * out);
  }
};

/// The open parts of the perimeter that lie in a window of the grid, as lines for CountOutflow: south, north,
/// west, east.
inline std::array<Window, 4> perimeterOf(const Window& cells, const OpenEdges& open, int columns, int rows) {
  const auto line = [](bool counts, int start, int begin, int end) {
    return counts ? Window{0, start + begin, 1, start + end} : Window{};
  };
  return {
      line(open.y_min && cells.row_begin == 0, 0, cells.column_begin, cells.column_end),
      line(open.y_max && cells.row_end == rows, columns, cells.column_begin, cells.column_end),
      line(open.x_min && cells.column_begin == 0, 2 * columns, cells.row_begin, cells.row_end),
      line(open.x_max && cells.column_end == columns, 2 * columns + rows, cells.row_begin, cells.row_end)};
}

/// Calls function(Step<…>) with the kind of step that these arguments need.
template <class Function>
auto withStep(const StepArguments& arguments, bool with_bodies, bool with_slopes, const Function& function) {
  if (with_bodies && with_slopes) return function(Step<true, true>{arguments});
  if (with_bodies) return function(Step<true, false>{arguments});
  if (with_slopes) return function(Step<false, true>{arguments});
  return function(Step<false, false>{arguments});
}

}  // namespace shallow_sand
