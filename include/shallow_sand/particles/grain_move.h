#pragma once

#include "shallow_sand/device/atomics.h"
#include "shallow_sand/device/block_size.h"
#include "shallow_sand/device/window.h"
#include "shallow_sand/particles/grain_flow.h"

namespace shallow_sand {

/// Tiles of the map, each once; as large as a block of threads, so that both backends divide the map alike.
struct TileList {
  int across;   ///< tiles in a row of the map
  int* listed;  ///< of each tile of the map, whether it is in the list
  int* tiles;
  int* length;

  static SHALLOW_SAND_HOST_DEVICE int tilesAlong(int cells, int of_tile) {
    return (cells + of_tile - 1) / of_tile;
  }

  /// Adds the tile of a cell of I.
  SHALLOW_SAND_HOST_DEVICE void add(int i, int j) const {
    const int tile = j / kBlockRows * across + i / kBlockColumns;
    if (atomicTake(&listed[tile])) tiles[atomicCount(length)] = tile;
  }
  /// Cells of the k-th tile of the list, of a map of so many columns and rows.
  SHALLOW_SAND_HOST_DEVICE Window cellsOf(int k, int columns, int rows) const {
    const int i = tiles[k] % across * kBlockColumns;
    const int j = tiles[k] / across * kBlockRows;
    return Window{i, j, i + kBlockColumns, j + kBlockRows}.overlap({0, 0, columns, rows});
  }
  SHALLOW_SAND_HOST_DEVICE bool holds(int tile) const { return listed[tile] != 0; }
  SHALLOW_SAND_HOST_DEVICE void remove(int tile) const { listed[tile] = 0; }
};

/// What a grain that comes to a cell tells: the largest claim of a cell wins it. 0 is none.
using Claim = unsigned long long;

constexpr std::uint32_t kClaimant = (1u << 26) - 1;  // bits of a claim that tell the cell from which it came
constexpr std::uint32_t kScramble = 0x2545F49;       // odd, so that no two cells become one

/// Of the grains that come to one cell only one remains, whatever the order of threads: one of sand goes
/// before one of bare ground, an older one before a younger. (The paper keeps the one that entered last: that
/// is chance, and tracks hardly anything beyond some cells.) Among those of an age their place decides, in an
/// order that favours no direction.
SHALLOW_SAND_HOST_DEVICE inline Claim claimOf(const Grain& grain, std::uint32_t cell) {
  const Claim some = 1ull << 63;
  const Claim of_sand = grain.isBare() ? 0 : 1ull << 62;
  const Claim youth = static_cast<Claim>(grain.born) << 26;
  return some | of_sand | ((0xFFFFFFFFull << 26) - youth) | ((cell * kScramble) & kClaimant);
}
/// The cell from which a claim came.
SHALLOW_SAND_HOST_DEVICE inline std::uint32_t claimantOf(Claim claim) {
  constexpr std::uint32_t kUnscramble = 0x1BEAC2F9;  // times kScramble it is 1, modulo 2^32
  static_assert(kScramble * kUnscramble == 1, "factors are inverse");
  return (static_cast<std::uint32_t>(claim) * kUnscramble) & kClaimant;
}

/// A move of all grains (section 6.2), in four passes, each over cells in any order:
/// - findFlow, of each cell of I that may move: its velocity, and the tiles in which grains move
/// - claim, of each cell of J in those tiles: its grain goes on within the cell, or claims another one
/// - settle, of each cell of J in the tiles of these and of what was claimed: who wins it
/// - finish, of the same tiles: the winners take their places, and all is as it was before the move
struct GrainMove {
  GrainFlow flow;
  float* u;  ///< those of `flow`; zeros before and after the move
  float* v;
  Grain* grains;
  Grain* next;
  Claim* claims;    ///< one a cell of J; zeros before and after the move
  TileList moving;  ///< these are empty before the move
  TileList reached;
  std::uint32_t number;  ///< of the move, from 1 on

  SHALLOW_SAND_HOST_DEVICE void findFlow(int i, int j) const {
    const int columns = flow.sand.step.columns;
    const int rows = flow.sand.step.rows;
    const long long at = flow.sand.step.index(i, j);
    const Momentum velocity = flow.sand.velocity(at, flow.speed);
    if (velocity.x == 0.0f && velocity.y == 0.0f) return;
    u[at] = velocity.x;
    v[at] = velocity.y;
    // Eq. 27 lets it count for grains of the cells around.
    for (int row = j > 0 ? j - 1 : 0; row <= j + 1 && row < rows; ++row) {
      for (int column = i > 0 ? i - 1 : 0; column <= i + 1 && column < columns; ++column)
        moving.add(column, row);
    }
  }

  SHALLOW_SAND_HOST_DEVICE void claim(int s, int t, int d) const {
    const long long cell = flow.grains.index(s, t, d);
    const Grain own = grains[cell];
    const GrainPlace place = flow.placeOf(own, s, t, d);
    const bool stays = !place.left && place.s == s && place.t == t;
    next[cell] = {stays ? place.x : kNoGrain, place.y, own.origin, own.born};
    if (stays || place.left) return;
    atomicRaise(&claims[flow.grains.index(place.s, place.t, d)],
                claimOf(own, static_cast<std::uint32_t>(cell)));
    reached.add(flow.grains.cellOfSand(place.s), flow.grains.cellOfSand(place.t));
  }

  /// @param moves whether the grain of the cell had part in claim()
  SHALLOW_SAND_HOST_DEVICE void settle(int s, int t, int d, bool moves) const {
    const long long cell = flow.grains.index(s, t, d);
    const Grain own = moves ? next[cell] : grains[cell];
    const bool stays = own.x != kNoGrain;
    const Claim came = claims[cell];
    if (came != 0 && !(stays && claimOf(own, static_cast<std::uint32_t>(cell)) > came)) {
      next[cell] = settled(claimantOf(came), d);
    } else if (!stays) {
      Grain grain = generatedGrain(static_cast<std::uint32_t>(cell), number, 0);
      grain.origin = grains[flow.upstreamOf(grain, s, t, d)].origin;
      next[cell] = grain;
    } else if (!moves) {
      next[cell] = own;
    }
  }

  SHALLOW_SAND_HOST_DEVICE void finish(int s, int t, int d) const {
    const long long cell = flow.grains.index(s, t, d);
    grains[cell] = next[cell];
    claims[cell] = 0;
  }
  SHALLOW_SAND_HOST_DEVICE void clearFlow(int i, int j) const {
    const long long at = flow.sand.step.index(i, j);
    u[at] = 0.0f;
    v[at] = 0.0f;
  }

 private:
  static constexpr float kNoGrain = -1.0f;  // as an offset: the grain has left the cell

  /// The grain of another cell where it comes to.
  SHALLOW_SAND_HOST_DEVICE Grain settled(std::uint32_t from, int d) const {
    const std::uint32_t columns = static_cast<std::uint32_t>(flow.grains.columns);
    const std::uint32_t line = from / columns;
    const int s = static_cast<int>(from - line * columns);
    const int t = static_cast<int>(line) - d * flow.grains.rows;
    const Grain grain = grains[from];
    const GrainPlace place = flow.placeOf(grain, s, t, d);
    return {place.x, place.y, grain.origin, grain.born};
  }
};

}  // namespace shallow_sand
