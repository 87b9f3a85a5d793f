#pragma once

#include "shallow_sand/coupling/given_momentum.h"
#include "shallow_sand/device/window.h"

namespace shallow_sand {

/// Distance of every column to the nearest one that can take the sand of a body, in cells and along the axes:
/// a pass along the columns, then one along the rows. A gap under a body that is lower than a cell takes
/// none: sand that a blade pushes would else end behind its edge. Calls (0, k): k counts columns of the
/// window.
struct DistanceAlongColumns {
  const float* clearance;
  const float* ground;  ///< depth of the sand under it [m]
  int* distance;
  int columns;
  float spacing;
  Window window;

  /// More than any way through a grid, and far from the end of an int.
  static constexpr int kFar = 1 << 29;

  SHALLOW_SAND_HOST_DEVICE void operator()(int, int k) const {
    const int i = window.column_begin + k;
    int nearest = kFar;
    for (int j = window.row_begin; j < window.row_end; ++j) {
      const long long at = static_cast<long long>(j) * columns + i;
      nearest = clearance[at] - ground[at] >= spacing ? 0 : (nearest < kFar ? nearest + 1 : kFar);
      distance[at] = nearest;
    }
    nearest = kFar;
    for (int j = window.row_end - 1; j >= window.row_begin; --j) {
      const long long at = static_cast<long long>(j) * columns + i;
      nearest = distance[at] == 0 ? 0 : (nearest < kFar ? nearest + 1 : kFar);
      distance[at] = distance[at] < nearest ? distance[at] : nearest;
    }
  }
};

/// The second pass. Calls (0, k): k counts rows of the window.
struct DistanceAlongRows {
  int* distance;
  int columns;
  Window window;

  SHALLOW_SAND_HOST_DEVICE void operator()(int, int k) const {
    int* row = distance + static_cast<long long>(window.row_begin + k) * columns;
    for (int i = window.column_begin + 1; i < window.column_end; ++i) {
      row[i] = row[i] <= row[i - 1] ? row[i] : row[i - 1] + 1;
    }
    for (int i = window.column_end - 2; i >= window.column_begin; --i) {
      row[i] = row[i] <= row[i + 1] ? row[i] : row[i + 1] + 1;
    }
  }
};

/// What the sand of a column may do when bodies have come: each of the two layers keeps what there is room
/// for, and hands the rest to neighbours.
struct Outflow {
  float excess;   ///< depth that must go [m]
  float share;    ///< of it, to each neighbour that takes some [m]
  Momentum with;  ///< momentum that goes with a share [m²/s]
  bool to_west;
  bool to_east;
  bool to_south;
  bool to_north;

  /// A moving body pushes ahead and aside: sand goes behind it only if it can go nowhere else. Without this a
  /// blade one cell thick would let half of its sand through.
  SHALLOW_SAND_HOST_DEVICE void keepAhead(float velocity_x, float velocity_y) {
    const bool west = to_west && !(velocity_x > 0.0f);
    const bool east = to_east && !(velocity_x < 0.0f);
    const bool south = to_south && !(velocity_y > 0.0f);
    const bool north = to_north && !(velocity_y < 0.0f);
    if (!(west || east || south || north)) return;
    to_west = west;
    to_east = east;
    to_south = south;
    to_north = north;
  }

  /// Divides what must go among those that take some, the ones behind a moving body last. Nothing goes if
  /// there is none. Returns how many there are.
  SHALLOW_SAND_HOST_DEVICE int divide(float depth, float velocity_x, float velocity_y) {
    keepAhead(velocity_x, velocity_y);
    if (takers() == 0) return 0;
    excess = depth;
    share = depth / static_cast<float>(takers());
    return takers();
  }
  SHALLOW_SAND_HOST_DEVICE int takers() const { return to_west + to_east + to_south + to_north; }
};

/// Sand that has no room goes to neighbours: the ground's to those that are nearer to the body's edge, a load
/// to those whose support is lower. It takes the velocity along that Eq. 20 gives it; the vertical motion of
/// the body pushes the sand of its neighbours (Eq. 24). Written as a gather, so the order of cells does not
/// matter and no sand is lost. Decides which columns are closed.
struct DisplaceSand {
  ContactFields contact;
  const int* distance;
  SandLayer ground;  ///< as MeetBodies left it
  SandLayer load;
  const float* bed;
  SandColumns columns;  ///< is written
  SandLayer pushed;     ///< is written: what was pushed to columns that no body covers
  GivenInWindow given;  ///< is written; the outermost cells of its window are clear of bodies, or at the edge
                        ///< of the grid
  int across;           ///< cells in a row
  float spacing;
  /// Sand goes on from where it came to without room: bodies have pushed what is beside them before. Then
  /// columns change only where there is such sand, or beside it.
  bool again;

  SHALLOW_SAND_HOST_DEVICE long long index(int i, int j) const {
    return static_cast<long long>(j) * across + i;
  }
  SHALLOW_SAND_HOST_DEVICE bool nearer(int i, int j, int than) const {
    return given.window.holds(i, j) && distance[index(i, j)] < than;
  }
  SHALLOW_SAND_HOST_DEVICE bool lower(int i, int j, float than) const {
    if (!given.window.holds(i, j)) return false;
    const long long at = index(i, j);
    return (contact.isCovered(at) ? contact.top[at] : bed[at] + ground.depth[at]) < than;
  }

  /// Whether a column has more sand than room.
  SHALLOW_SAND_HOST_DEVICE bool overflows(int i, int j) const {
    if (!given.window.holds(i, j)) return false;
    const long long at = index(i, j);
    return ground.depth[at] > contact.clearance[at] || load.depth[at] > contact.headroom[at] ||
           contact.swept[at] != 0;
  }
  SHALLOW_SAND_HOST_DEVICE bool pushes(int i, int j) const {
    return !again && given.window.holds(i, j) && contact.length[index(i, j)] > 0.0f;
  }
  /// Whether nothing comes to a column or goes from it.
  SHALLOW_SAND_HOST_DEVICE bool isLeftAlone(int i, int j) const {
    const bool overflow = overflows(i, j) || overflows(i - 1, j) || overflows(i + 1, j) ||
                          overflows(i, j - 1) || overflows(i, j + 1);
    return !overflow && !(pushes(i - 1, j) || pushes(i + 1, j) || pushes(i, j - 1) || pushes(i, j + 1));
  }

  /// Whether a column takes load of another one: of one that a wall sweeps, if it is lower; of one under a
  /// body that comes down, if it is nearer to the edge.
  SHALLOW_SAND_HOST_DEVICE bool takesLoad(int i, int j, long long of) const {
    if (contact.swept[of] != 0) return lower(i, j, contact.top[of]);
    return nearer(i, j, distance[of]) || (given.window.holds(i, j) && !contact.isCovered(index(i, j)));
  }

  SHALLOW_SAND_HOST_DEVICE Outflow ofGround(int i, int j) const {
    Outflow out{};
    if (!given.window.holds(i, j)) return out;
    const long long at = index(i, j);
    const float h = ground.depth[at];
    const float excess = h - contact.clearance[at];
    if (!(excess > 0.0f)) return out;
    const int own = distance[at];
    out.to_west = nearer(i - 1, j, own);
    out.to_east = nearer(i + 1, j, own);
    out.to_south = nearer(i, j - 1, own);
    out.to_north = nearer(i, j + 1, own);
    const int takers = out.divide(excess, contact.velocity_x[at], contact.velocity_y[at]);
    if (takers == 0) return out;
    // Eq. 20 for the part that goes: Ω_s moves with the body, the sand above it as before.
    const float solid = minimum(contact.length[at], excess) / static_cast<float>(takers);
    const float loose = (out.share - solid) / h;
    out.with.x = solid * contact.velocity_x[at] + loose * ground.momentum_x[at];
    out.with.y = solid * contact.velocity_y[at] + loose * ground.momentum_y[at];
    return out;
  }

  SHALLOW_SAND_HOST_DEVICE Outflow ofLoad(int i, int j) const {
    Outflow out{};
    if (!given.window.holds(i, j)) return out;
    const long long at = index(i, j);
    const float excess = load.depth[at] - (contact.swept[at] != 0 ? 0.0f : contact.headroom[at]);
    if (!contact.isCovered(at) || !(excess > 0.0f)) return out;
    out.to_west = takesLoad(i - 1, j, at);
    out.to_east = takesLoad(i + 1, j, at);
    out.to_south = takesLoad(i, j - 1, at);
    out.to_north = takesLoad(i, j + 1, at);
    out.divide(excess, contact.velocity_x[at], contact.velocity_y[at]);
    out.with = {out.share * contact.velocity_x[at], out.share * contact.velocity_y[at]};
    return out;
  }

  /// What flows in from the four neighbours.
  SHALLOW_SAND_HOST_DEVICE static Sand gathered(const Outflow& west, const Outflow& east,
                                                const Outflow& south, const Outflow& north) {
    const float w = west.to_east ? 1.0f : 0.0f;
    const float e = east.to_west ? 1.0f : 0.0f;
    const float s = south.to_north ? 1.0f : 0.0f;
    const float n = north.to_south ? 1.0f : 0.0f;
    return {(w * west.share + e * east.share) + (s * south.share + n * north.share),
            (w * west.with.x + e * east.with.x) + (s * south.with.x + n * north.with.x),
            (w * west.with.y + e * east.with.y) + (s * south.with.y + n * north.with.y)};
  }

  /// Part of a column's sand that stays. One that gives its excess away is exactly full; a difference could
  /// be off by a rounding. What the body gives to that sand and to what goes is added to `got`.
  SHALLOW_SAND_HOST_DEVICE static Sand kept(const Sand& sand, const Outflow& out, float room, Momentum& got) {
    if (!(out.excess > 0.0f)) return sand;
    const float takers = static_cast<float>(out.takers());
    got.x += takers * out.with.x - sand.hu;
    got.y += takers * out.with.y - sand.hv;
    return {room, 0.0f, 0.0f};
  }

  SHALLOW_SAND_HOST_DEVICE void operator()(int i, int j) const {
    const long long at = index(i, j);
    Sand below = ground.get(at);
    Sand above = load.get(at);
    Sand came;
    GivenMomentum got{};
    const bool covered = contact.isCovered(at);
    const bool left_alone = isLeftAlone(i, j);
    if (!left_alone) came = exchange(i, j, below, above, got.own);
    const bool closed = covered && isFull(below.h, contact.clearance[at], spacing);
    if (!left_alone && below.h > 0.0f && !closed)
      VerticalPush{contact, ground.depth, across, spacing, given.window}(i, j, below, got);
    if (closed) {
      got.own = {got.own.x - below.hu, got.own.y - below.hv};
      below = {below.h, 0.0f, 0.0f};
    }
    columns.cover[at] = closed ? Cover::touching : (covered ? Cover::hanging : Cover::none);
    columns.visible.set(at, closed ? above : below);
    columns.hidden.set(at, closed ? below : above);
    columns.visible_bed[at] = closed ? contact.top[at] : bed[at];
    columns.ceiling[at] = closed ? contact.headroom[at] : contact.clearance[at];
    pushed.set(at, came);
    given.set(i, j, got);
  }

 private:
  /// Gives away what there is no room for, and takes what neighbours give. Returns what comes to a column
  /// that no body covers; under or on a body it stays where it comes to.
  SHALLOW_SAND_HOST_DEVICE Sand exchange(int i, int j, Sand& below, Sand& above, Momentum& got) const {
    const long long at = index(i, j);
    below = kept(below, ofGround(i, j), contact.clearance[at], got);
    above = kept(above, ofLoad(i, j), contact.swept[at] != 0 ? 0.0f : contact.headroom[at], got);
    const Sand to_ground =
        gathered(ofGround(i - 1, j), ofGround(i + 1, j), ofGround(i, j - 1), ofGround(i, j + 1));
    const Sand to_load = gathered(ofLoad(i - 1, j), ofLoad(i + 1, j), ofLoad(i, j - 1), ofLoad(i, j + 1));
    if (!contact.isCovered(at)) return sumOf(to_ground, to_load);
    below = sumOf(below, to_ground);
    above = sumOf(above, to_load);
    return {};
  }
};

/// Sand that still has to go from under bodies, if above 0. [m]
struct SandWithoutRoom {
  ContactFields contact;
  SandColumns columns;
  int across;

  SHALLOW_SAND_HOST_DEVICE float operator()(int i, int j) const {
    const long long at = static_cast<long long>(j) * across + i;
    if (!contact.isCovered(at)) return 0.0f;
    return maximum(columns.ground(at).h - contact.clearance[at], columns.load(at).h - contact.headroom[at]);
  }
};

/// Largest speed that bodies in the sand, and sand that hangs on bodies, ask a step to follow. [m/s]
struct ContactSpeed {
  ContactFields contact;
  SandColumns columns;
  Step<true, false> step;  ///< the one that asks

  SHALLOW_SAND_HOST_DEVICE float operator()(int i, int j) const {
    const long long at = step.index(i, j);
    if (!contact.isCovered(at)) return 0.0f;
    const Sand load = columns.load(at);
    float speed = 0.0f;
    if (contact.length[at] > 0.0f || load.h > 0.0f) {
      speed = maximum(maximum(fabsf(contact.velocity_x[at]), fabsf(contact.velocity_y[at])),
                      fabsf(contact.velocity_z[at]));
    }
    if (columns.cover[at] != Cover::hanging || !(load.h > 0.0f)) return speed;
    // How much room it has does not matter to its speed.
    const Cell cell = step.cell(load.h, load.hu, load.hv, contact.top[at],
                                std::numeric_limits<float>::infinity(), step.materialAt(at));
    return maximum(speed, step.signalSpeed(cell));
  }
};

}  // namespace shallow_sand
