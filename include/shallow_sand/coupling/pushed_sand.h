#pragma once

#include "shallow_sand/coupling/contact.h"
#include "shallow_sand/device/window.h"

namespace shallow_sand {

/// Depth of the sand that was pushed to a column. [m]
struct PushedDepth {
  const float* depth;
  int across;  ///< cells in a row

  SHALLOW_SAND_HOST_DEVICE float operator()(int i, int j) const {
    return depth[static_cast<long long>(j) * across + i];
  }
};

/// Empties a layer.
struct NoSand {
  SandLayer layer;
  int across;

  SHALLOW_SAND_HOST_DEVICE void operator()(int i, int j) const {
    layer.set(static_cast<long long>(j) * across + i, {});
  }
};

/// Sand that a body pushed out of one column stands on the next as a tower, for the body's side moves on by
/// whole columns. Let fall, it would gain speed that sand before a real blade does not have, and run out far
/// below the angle of repose. So pushed sand first goes down from column to column, as far as friction cannot
/// hold it, with the momentum that it has. One pass; only sand that was just pushed moves. A column that gives
/// all of it away has given some to a neighbour: so what needs a pass is at most a cell from pushed sand, and
/// `to` is 0 elsewhere if it was before.
struct LowerPushedSand {
  SandColumns columns;
  const float* repose_rise;  ///< null where the material is the same everywhere
  SandConstants sand;
  SandLayer from;  ///< pushed sand, not yet part of its columns
  SandLayer to;
  int across;  ///< cells in a row
  Window window;

  /// What goes from a column to its neighbours. [m]
  struct Fall {
    float west = 0.0f;
    float east = 0.0f;
    float south = 0.0f;
    float north = 0.0f;

    SHALLOW_SAND_HOST_DEVICE float sum() const { return (west + east) + (south + north); }
  };

  SHALLOW_SAND_HOST_DEVICE void operator()(int i, int j) const {
    const long long at = index(i, j);
    if (nothingNear(i, j)) return to.set(at, {});
    const Sand own = from.get(at);
    const float stays = own.h > 0.0f ? maximum(own.h - fall(i, j).sum(), 0.0f) / own.h : 0.0f;
    const Sand kept{stays * own.h, stays * own.hu, stays * own.hv};
    const Sand along_x = sumOf(part(i - 1, j, fall(i - 1, j).east), part(i + 1, j, fall(i + 1, j).west));
    const Sand along_y = sumOf(part(i, j - 1, fall(i, j - 1).north), part(i, j + 1, fall(i, j + 1).south));
    to.set(at, sumOf(kept, sumOf(along_x, along_y)));
  }

 private:
  SHALLOW_SAND_HOST_DEVICE long long index(int i, int j) const {
    return static_cast<long long>(j) * across + i;
  }
  SHALLOW_SAND_HOST_DEVICE bool nothingAt(int i, int j) const {
    return !window.holds(i, j) || !(from.depth[index(i, j)] > 0.0f);
  }
  SHALLOW_SAND_HOST_DEVICE bool nothingNear(int i, int j) const {
    return nothingAt(i, j) && nothingAt(i - 1, j) && nothingAt(i + 1, j) && nothingAt(i, j - 1) &&
           nothingAt(i, j + 1);
  }
  SHALLOW_SAND_HOST_DEVICE float surface(long long at) const {
    return columns.visible_bed[at] + (columns.visible.depth[at] + from.depth[at]);
  }
  /// By how much a neighbour's surface is lower than friction holds. [m]
  SHALLOW_SAND_HOST_DEVICE float drop(long long at, int i, int j, float level_rise) const {
    if (!window.holds(i, j)) return 0.0f;
    const long long there = index(i, j);
    if (columns.cover[there] == Cover::hanging) return 0.0f;
    const float held = repose_rise == nullptr ? sand.uniform.repose_rise : repose_rise[at];
    return maximum((surface(at) - surface(there)) + level_rise - held, 0.0f);
  }

  SHALLOW_SAND_HOST_DEVICE Fall fall(int i, int j) const {
    Fall fall;
    if (!window.holds(i, j)) return fall;
    const long long at = index(i, j);
    const float pushed = from.depth[at];
    if (!(pushed > 0.0f)) return fall;
    fall = {drop(at, i - 1, j, -sand.level_x), drop(at, i + 1, j, sand.level_x),
            drop(at, i, j - 1, -sand.level_y), drop(at, i, j + 1, sand.level_y)};
    const float takers = (fall.west > 0.0f ? 1.0f : 0.0f) + (fall.east > 0.0f ? 1.0f : 0.0f) +
                         (fall.south > 0.0f ? 1.0f : 0.0f) + (fall.north > 0.0f ? 1.0f : 0.0f);
    // The column and those that take from it come to lie level, but for what friction holds.
    const float part = 1.0f / (takers + 1.0f);
    const float share = part * minimum(1.0f, pushed / maximum(part * fall.sum(), 1e-30f));
    return {share * fall.west, share * fall.east, share * fall.south, share * fall.north};
  }

  /// So much of a column's pushed sand, with its momentum.
  SHALLOW_SAND_HOST_DEVICE Sand part(int i, int j, float depth) const {
    if (!(depth > 0.0f)) return {};
    const Sand whole = from.get(index(i, j));
    const float share = depth / whole.h;
    return {depth, share * whole.hu, share * whole.hv};
  }
};

/// Pushed sand becomes part of the columns on which it lies.
struct LayPushedSand {
  SandColumns columns;
  SandLayer pushed;  ///< is 0 afterwards
  int across;

  SHALLOW_SAND_HOST_DEVICE void operator()(int i, int j) const {
    const long long at = static_cast<long long>(j) * across + i;
    const Sand more = pushed.get(at);
    if (!(more.h > 0.0f)) return;
    pushed.set(at, {});
    columns.visible.set(at, sumOf(columns.visible.get(at), more));
  }
};

}  // namespace shallow_sand
