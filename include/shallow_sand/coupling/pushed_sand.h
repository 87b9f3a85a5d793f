#pragma once

#include "shallow_sand/coupling/contact.h"
#include "shallow_sand/device/window.h"

namespace shallow_sand {

constexpr int kPassesOfPushedSand = 8;  ///< in which pushed sand goes down; even

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

/// By how much the surfaces of a column's neighbours are lower than friction holds. [m]
struct Drops {
  float west;
  float east;
  float south;
  float north;

  SHALLOW_SAND_HOST_DEVICE float sum() const { return (west + east) + (south + north); }
};

/// Sand that a body pushed out of one column stands on the next as a tower, for the body's side moves on by
/// whole columns. Let fall, it would gain speed that sand before a real blade does not have, and run out far
/// below the angle of repose. So pushed sand first goes down from column to column, as far as friction cannot
/// hold it, with the momentum that it has, in some passes; only sand that was just pushed moves.
struct PushedSand {
  SandColumns columns;
  const float* repose_rise;  ///< null where the material is the same everywhere
  SandConstants sand;
  SandLayer from;  ///< pushed sand, not yet part of its columns
  float* part;     ///< of what a column stands too high above a lower neighbour, that goes there
  int across;      ///< cells in a row
  Window window;

  SHALLOW_SAND_HOST_DEVICE long long index(int i, int j) const {
    return static_cast<long long>(j) * across + i;
  }
  SHALLOW_SAND_HOST_DEVICE float surface(long long at) const {
    return columns.visible_bed[at] + (columns.visible.depth[at] + from.depth[at]);
  }
  /// By how much a neighbour's surface is lower than friction holds; under a body there is no place. [m]
  SHALLOW_SAND_HOST_DEVICE float drop(long long at, int i, int j, float level_rise) const {
    if (!window.holds(i, j)) return 0.0f;
    const long long there = index(i, j);
    if (columns.ceiling[there] < 1e30f) return 0.0f;
    const float held = repose_rise == nullptr ? sand.uniform.repose_rise : repose_rise[at];
    return maximum((surface(at) - surface(there)) + level_rise - held, 0.0f);
  }
  /// A part of the drops to all neighbours.
  SHALLOW_SAND_HOST_DEVICE Drops drops(int i, int j, float part) const {
    const long long at = index(i, j);
    return {part * drop(at, i - 1, j, -sand.level_x), part * drop(at, i + 1, j, sand.level_x),
            part * drop(at, i, j - 1, -sand.level_y), part * drop(at, i, j + 1, sand.level_y)};
  }
};

/// How much of a column's pushed sand goes to its neighbours: it and those that take from it come to lie
/// level, but for what friction holds.
struct DividePushedSand {
  PushedSand pushed;

  SHALLOW_SAND_HOST_DEVICE void operator()(int i, int j) const {
    const long long at = pushed.index(i, j);
    const float depth = pushed.from.depth[at];
    if (!(depth > 0.0f)) return;
    const Drops drops = pushed.drops(i, j, 1.0f);
    const float takers = (drops.west > 0.0f ? 1.0f : 0.0f) + (drops.east > 0.0f ? 1.0f : 0.0f) +
                         (drops.south > 0.0f ? 1.0f : 0.0f) + (drops.north > 0.0f ? 1.0f : 0.0f);
    const float level = 1.0f / (takers + 1.0f);
    const float sum = drops.sum();
    pushed.part[at] = sum > 0.0f ? level * minimum(1.0f, depth / maximum(level * sum, 1e-30f)) : 0.0f;
  }
};

/// One pass. A column that gives all of its pushed sand away has given some to a neighbour: so work is at
/// most a cell from pushed sand, and `to` stays 0 elsewhere.
struct LowerPushedSand {
  PushedSand pushed;
  SandLayer to;

  SHALLOW_SAND_HOST_DEVICE void operator()(int i, int j) const {
    const long long at = pushed.index(i, j);
    const SandConstants& sand = pushed.sand;
    const Sand along_x =
        sumOf(cameFrom(i - 1, j, i, j, sand.level_x), cameFrom(i + 1, j, i, j, -sand.level_x));
    const Sand along_y =
        sumOf(cameFrom(i, j - 1, i, j, sand.level_y), cameFrom(i, j + 1, i, j, -sand.level_y));
    to.set(at, sumOf(kept(at, i, j), sumOf(along_x, along_y)));
  }

 private:
  SHALLOW_SAND_HOST_DEVICE Sand kept(long long at, int i, int j) const {
    const Sand own = pushed.from.get(at);
    if (!(own.h > 0.0f)) return {};
    const float part = pushed.part[at];
    if (!(part > 0.0f)) return own;
    const float stays = maximum(own.h - pushed.drops(i, j, part).sum(), 0.0f) / own.h;
    return {stays * own.h, stays * own.hu, stays * own.hv};
  }

  /// What a neighbour's pushed sand sends here, with its momentum.
  SHALLOW_SAND_HOST_DEVICE Sand cameFrom(int ni, int nj, int i, int j, float level_rise) const {
    if (!pushed.window.holds(ni, nj)) return {};
    const long long there = pushed.index(ni, nj);
    const float depth = pushed.from.depth[there];
    if (!(depth > 0.0f) || !(pushed.part[there] > 0.0f)) return {};
    const float fall = pushed.part[there] * pushed.drop(there, i, j, level_rise);
    const float share = fall / depth;
    return {fall, share * pushed.from.momentum_x[there], share * pushed.from.momentum_y[there]};
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
