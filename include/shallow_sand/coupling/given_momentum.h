#pragma once

#include <cstdint>

#include "shallow_sand/coupling/contact.h"
#include "shallow_sand/device/window.h"

namespace shallow_sand {

/// Momentum that bodies give to the sand of a column when it makes way for them, over its area. [m²/s]
struct GivenMomentum {
  Momentum own;  ///< by the body that moves the column (Eq. 20)
  float west;    ///< along x, by the one that moves the next column to the west (Eq. 24)
  float east;
  float south;  ///< along y
  float north;
};

/// That of each column of a window, row by row.
struct GivenInWindow {
  GivenMomentum* columns;
  std::uint8_t* some;  ///< whether a column got any: what the others got is not written
  Window window;

  SHALLOW_SAND_HOST_DEVICE long long index(int i, int j) const {
    return static_cast<long long>(j - window.row_begin) * window.columns() + (i - window.column_begin);
  }
  SHALLOW_SAND_HOST_DEVICE void set(int i, int j, const GivenMomentum& given) const {
    const bool any = given.own.x != 0.0f || given.own.y != 0.0f || given.west != 0.0f || given.east != 0.0f ||
                     given.south != 0.0f || given.north != 0.0f;
    some[index(i, j)] = any ? 1 : 0;
    if (any) columns[index(i, j)] = given;
  }
};

/// Vertical motion of the bodies in columns, which pushes the sand of their neighbours aside (Eq. 24).
struct VerticalPush {
  ContactFields contact;
  const float* depth;  ///< of the sand that they are in [m]
  int across;          ///< cells in a row
  float spacing;
  Window window;  ///< beyond it no body moves

  SHALLOW_SAND_HOST_DEVICE float velocity(int i, int j) const {
    if (!window.holds(i, j)) return 0.0f;
    const long long at = static_cast<long long>(j) * across + i;
    return meanVerticalVelocity(contact.length[at], contact.velocity_z[at], depth[at]);
  }

  SHALLOW_SAND_HOST_DEVICE void operator()(int i, int j, Sand& sand, GivenMomentum& given) const {
    // As Eq. 23 has it, hu takes the difference along x only, hv the one along y only.
    push(sand.h, velocity(i - 1, j), velocity(i + 1, j), sand.hu, given.west, given.east);
    push(sand.h, velocity(i, j - 1), velocity(i, j + 1), sand.hv, given.south, given.north);
  }

 private:
  /// Of what two neighbours give, each gives as much as it pushes: one that sinks pushes away, one that rises
  /// draws near. One that holds back gives nothing.
  SHALLOW_SAND_HOST_DEVICE void push(float h, float below, float above, float& momentum, float& by_below,
                                     float& by_above) const {
    const float pushed = pushedAside(momentum, h, above - below, spacing);
    const float given = pushed - momentum;
    momentum = pushed;
    if (given == 0.0f) return;
    const float forward = given > 0.0f ? 1.0f : -1.0f;
    const float push_below = maximum(-forward * below, 0.0f);
    const float push_above = maximum(forward * above, 0.0f);
    const float all = push_below + push_above;
    by_below += given * (push_below / all);
    by_above += given * (push_above / all);
  }
};

/// Adds what the columns of a row of the window got to what each body gave before. Calls (0, k): k counts
/// rows of the window.
struct AddGiven {
  GivenInWindow given;
  const int* body;  ///< see ContactFields
  /// For each body, along x and y for each row of the grid; null for one that was removed. [m²/s]
  double* const* sums;
  int across;  ///< cells in a row

  SHALLOW_SAND_HOST_DEVICE void operator()(int, int k) const {
    const int j = given.window.row_begin + k;
    for (int i = given.window.column_begin; i < given.window.column_end; ++i) {
      if (given.some[given.index(i, j)] == 0) continue;
      const GivenMomentum& here = given.columns[given.index(i, j)];
      const long long at = static_cast<long long>(j) * across + i;
      add(here.own, at, j);
      add({here.west, 0.0f}, at - 1, j);
      add({here.east, 0.0f}, at + 1, j);
      add({0.0f, here.south}, at - across, j);
      add({0.0f, here.north}, at + across, j);
    }
  }

 private:
  /// @param at the column whose body gave it
  SHALLOW_SAND_HOST_DEVICE void add(const Momentum& momentum, long long at, int j) const {
    if (momentum.x == 0.0f && momentum.y == 0.0f) return;
    if (body[at] < 0 || sums[body[at]] == nullptr) return;
    double* sum = sums[body[at]] + 2 * static_cast<long long>(j);
    sum[0] += static_cast<double>(momentum.x);
    sum[1] += static_cast<double>(momentum.y);
  }
};

}  // namespace shallow_sand
