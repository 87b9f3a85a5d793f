#pragma once

#include "shallow_sand/coupling/rays.h"
#include "shallow_sand/device/window.h"
#include "shallow_sand/solver/equations.h"

namespace shallow_sand {

/// Distance of every column to the nearest one that can take the sand of a body, in cells and along the axes:
/// a pass along the columns, then one along the rows. A gap under a body that is lower than a cell takes
/// none: sand that a blade pushes would else end behind its edge. Calls (0, k): k counts columns of the
/// window.
struct DistanceAlongColumns {
  ContactFields contact;
  const float* depth;
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
      nearest = contact.ceiling[at] - depth[at] >= spacing ? 0 : (nearest < kFar ? nearest + 1 : kFar);
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

/// Sand that lies where a body is goes to those neighbours that are nearer to the body's edge, with the
/// velocity that Eq. 20 gives it; the vertical motion of the body pushes the sand of its neighbours (Eq. 24).
/// Written as a gather, so the order of cells does not matter and no sand is lost.
struct DisplaceSand {
  ContactFields contact;
  const int* distance;
  const float* depth_in;
  const float* momentum_x_in;
  const float* momentum_y_in;
  float* depth;
  float* momentum_x;
  float* momentum_y;
  int columns;
  float spacing;
  Window window;  ///< of the distances; its outermost cells are clear of bodies or at the edge of the grid

  struct Column {
    float excess;      ///< depth of the sand that must go [m]
    float share;       ///< of it, to each neighbour that takes some [m]
    Momentum carried;  ///< momentum that goes with a share
    bool to_west;
    bool to_east;
    bool to_south;
    bool to_north;
  };

  SHALLOW_SAND_HOST_DEVICE bool inside(int i, int j) const {
    return i >= window.column_begin && i < window.column_end && j >= window.row_begin && j < window.row_end;
  }
  SHALLOW_SAND_HOST_DEVICE long long index(int i, int j) const {
    return static_cast<long long>(j) * columns + i;
  }
  SHALLOW_SAND_HOST_DEVICE bool nearer(int i, int j, int than) const {
    return inside(i, j) && distance[index(i, j)] < than;
  }

  SHALLOW_SAND_HOST_DEVICE Column column(int i, int j) const {
    Column c{0.0f, 0.0f, {0.0f, 0.0f}, false, false, false, false};
    if (!inside(i, j)) return c;
    const long long at = index(i, j);
    const float h = depth_in[at];
    const float excess = h - contact.ceiling[at];
    if (!(excess > 0.0f)) return c;
    const int own = distance[at];
    c.to_west = nearer(i - 1, j, own);
    c.to_east = nearer(i + 1, j, own);
    c.to_south = nearer(i, j - 1, own);
    c.to_north = nearer(i, j + 1, own);
    keepAhead(c, contact.velocity_x[at], contact.velocity_y[at]);
    const int takers = c.to_west + c.to_east + c.to_south + c.to_north;
    if (takers == 0) return c;
    c.excess = excess;
    c.share = excess / static_cast<float>(takers);
    // Eq. 20 for the part that goes: Ω_s moves with the body, the sand above it as before.
    const float solid = minimum(contact.length[at], excess) / static_cast<float>(takers);
    const float loose = (c.share - solid) / h;
    c.carried.x = solid * contact.velocity_x[at] + loose * momentum_x_in[at];
    c.carried.y = solid * contact.velocity_y[at] + loose * momentum_y_in[at];
    return c;
  }

  /// A moving body pushes ahead and aside: sand goes behind it only if it can go nowhere else. Without this a
  /// blade one cell thick would let half of its sand through.
  SHALLOW_SAND_HOST_DEVICE static void keepAhead(Column& c, float velocity_x, float velocity_y) {
    const bool west = c.to_west && !(velocity_x > 0.0f);
    const bool east = c.to_east && !(velocity_x < 0.0f);
    const bool south = c.to_south && !(velocity_y > 0.0f);
    const bool north = c.to_north && !(velocity_y < 0.0f);
    if (!(west || east || south || north)) return;
    c.to_west = west;
    c.to_east = east;
    c.to_south = south;
    c.to_north = north;
  }

  /// w̃ of Eq. 20. [m/s]
  SHALLOW_SAND_HOST_DEVICE float verticalVelocity(int i, int j) const {
    if (!inside(i, j)) return 0.0f;
    const long long at = index(i, j);
    const float h = depth_in[at];
    return contact.length[at] > 0.0f && h > 0.0f ? contact.length[at] * contact.velocity_z[at] / h : 0.0f;
  }

  /// Momentum of sand beside a body that moves up or down (Eq. 24). The paper adds ΔL/2·Δw̃ in every step, so
  /// that it grows with their number; here it is what the momentum is brought to. Sand thinner than half a
  /// cell is pushed no faster than the body moves.
  SHALLOW_SAND_HOST_DEVICE float pushed(float momentum, float h, float difference) const {
    const float target = minimum(0.5f * spacing, h) * difference;
    if (target > 0.0f) return maximum(momentum, target);
    return target < 0.0f ? minimum(momentum, target) : momentum;
  }

  SHALLOW_SAND_HOST_DEVICE void operator()(int i, int j) const {
    const long long at = index(i, j);
    const Column own = column(i, j);
    const Column west = column(i - 1, j);
    const Column east = column(i + 1, j);
    const Column south = column(i, j - 1);
    const Column north = column(i, j + 1);
    const float from_west = west.to_east ? west.share : 0.0f;
    const float from_east = east.to_west ? east.share : 0.0f;
    const float from_south = south.to_north ? south.share : 0.0f;
    const float from_north = north.to_south ? north.share : 0.0f;
    // A column that gave its excess away is exactly full; a difference could be off by a rounding.
    const float kept = own.excess > 0.0f ? contact.ceiling[at] : depth_in[at];
    const float h = kept + ((from_west + from_east) + (from_south + from_north));
    float hu = own.excess > 0.0f ? 0.0f : momentum_x_in[at];
    float hv = own.excess > 0.0f ? 0.0f : momentum_y_in[at];
    hu += ((west.to_east ? west.carried.x : 0.0f) + (east.to_west ? east.carried.x : 0.0f)) +
          ((south.to_north ? south.carried.x : 0.0f) + (north.to_south ? north.carried.x : 0.0f));
    hv += ((west.to_east ? west.carried.y : 0.0f) + (east.to_west ? east.carried.y : 0.0f)) +
          ((south.to_north ? south.carried.y : 0.0f) + (north.to_south ? north.carried.y : 0.0f));
    if (h > 0.0f && !isFull(h, contact.ceiling[at], spacing)) {
      // As Eq. 23 has it, hu takes the difference along x only, hv the one along y only.
      hu = pushed(hu, h, verticalVelocity(i + 1, j) - verticalVelocity(i - 1, j));
      hv = pushed(hv, h, verticalVelocity(i, j + 1) - verticalVelocity(i, j - 1));
    }
    depth[at] = h;
    // Adding 0 leaves no negative zeros, which would be bits that a step changes.
    momentum_x[at] = hu + 0.0f;
    momentum_y[at] = hv + 0.0f;
  }
};

}  // namespace shallow_sand
