#pragma once

#include "shallow_sand/device/grid_team.cuh"
#include "shallow_sand/device/window.h"
#include "shallow_sand/solver/step.h"
#include "shallow_sand/solver/tiles.h"

namespace shallow_sand {

/// Number of a step since the sand began.
using StepNumber = unsigned long long;

/// Which tiles of the map have to be stepped, on the GPU: what Tiles is on the CPU, as lists that blocks of
/// threads work off. There is one for the present step, one that it fills for the next, and one that it
/// empties. A tile is as large as a block; the last ones of a row or column may be smaller.
struct DueTiles {
  static constexpr int kLists = 3;
  static constexpr int kReach = Tiles::kReach;
  static constexpr StepNumber kNever = ~0ULL;

  int columns;  ///< of cells
  int rows;
  int across;              ///< tiles in a row
  int count;               ///< of all tiles
  StepNumber* listed;      ///< of each tile in each list, the last step for which it was listed there
  int* lists;              ///< numbers of tiles; each list has room for all
  int* lengths;            ///< of the lists
  int* cells;              ///< in the tiles of each list
  int* crowded;            ///< of each list, whether a tile is near bodies
  float* speeds;           ///< of each tile, largest signal speed before its last step [m/s]
  unsigned char* is_near;  ///< of each tile, whether it is near bodies
  unsigned char* changed;  ///< of each tile, whether it may have changed since it was sent to the host

  static __host__ __device__ int tilesAcross(int cells) {
    return (cells + kBlockColumns - 1) / kBlockColumns;
  }
  static __host__ __device__ int tilesUp(int cells) { return (cells + kBlockRows - 1) / kBlockRows; }

  __device__ static int listOf(StepNumber step) { return static_cast<int>(step % kLists); }
  __device__ int& tile(int list, int k) const { return lists[static_cast<long long>(list) * count + k]; }
  __device__ StepNumber& lastListed(int list, int tile) const {
    return listed[static_cast<long long>(list) * count + tile];
  }
  __device__ bool isDue(int tile, StepNumber step) const { return lastListed(listOf(step), tile) == step; }
  __device__ void empty(int list) const { lengths[list] = cells[list] = crowded[list] = 0; }

  /// The cells of a tile of a map of so many columns and rows.
  static __host__ __device__ Window cellsOf(int tile, int columns, int rows) {
    const int i = tile % tilesAcross(columns) * kBlockColumns;
    const int j = tile / tilesAcross(columns) * kBlockRows;
    return Window{i, j, i + kBlockColumns, j + kBlockRows}.overlap({0, 0, columns, rows});
  }
  __device__ Window cellsOf(int tile) const { return cellsOf(tile, columns, rows); }

  /// Lists a tile for a step, once.
  __device__ void add(int tile, StepNumber step) const {
    const int list = listOf(step);
    StepNumber* last = &lastListed(list, tile);
    if (*static_cast<volatile StepNumber*>(last) == step || atomicExch(last, step) == step) return;
    this->tile(list, atomicAdd(&lengths[list], 1)) = tile;
    const Window covered = cellsOf(tile);
    atomicAdd(&cells[list], covered.columns() * covered.rows());
    if (is_near[tile] != 0) atomicOr(&crowded[list], 1);
  }
  /// A cell has changed, or may change in ways that a step does not see: the tiles that feel it are due.
  __device__ void touch(int i, int j, StepNumber step) const {
    const int west = max(i - kReach, 0) / kBlockColumns;
    const int east = min(i + kReach, columns - 1) / kBlockColumns;
    const int south = max(j - kReach, 0) / kBlockRows;
    const int north = min(j + kReach, rows - 1) / kBlockRows;
    for (int row = south; row <= north; ++row) {
      for (int column = west; column <= east; ++column) {
        changed[row * across + column] = 1;
        add(row * across + column, step);
      }
    }
  }
};

/// Finds the largest value of a block's threads, one time after the other.
class BlockMaximum {
 public:
  /// Returns it to the first thread; others get anything. Waits for the block.
  __device__ float operator()(float value) {
    __shared__ float of_rows[2][kBlockRows];
    for (int offset = 16; offset > 0; offset /= 2)
      value = ::shallow_sand::maximum(value, __shfl_xor_sync(0xffffffffu, value, offset));
    // While the first thread reads one set, others may come again and write the other.
    float* rows = of_rows[turn_];
    turn_ = 1 - turn_;
    if (threadIdx.x == 0) rows[threadIdx.y] = value;
    __syncthreads();
    for (int row = 1; row < kBlockRows; ++row) value = ::shallow_sand::maximum(value, rows[row]);
    return value;
  }

 private:
  int turn_ = 0;
};

/// Steps a tile by a block of threads, a cell each, and lists for the next step the tiles that this one keeps
/// awake. Returns the largest signal speed that the thread met before the step. [m/s]
template <class Step>
__device__ float stepTile(const StepCell<Step>& cell, const DueTiles& tiles, int tile, StepNumber step) {
  const Window cells = tiles.cellsOf(tile);
  const int i = cells.column_begin + static_cast<int>(threadIdx.x);
  const int j = cells.row_begin + static_cast<int>(threadIdx.y);
  CellActivity found{0.0f, false};
  if (cells.holds(i, j)) found = cell.stepped(i, j);
  // A warp is a row of the tile.
  const unsigned moving = __ballot_sync(0xffffffffu, found.moves);
  constexpr unsigned kWest = (1u << DueTiles::kReach) - 1;
  constexpr unsigned kEast = kWest << (kBlockColumns - DueTiles::kReach);
  const int row = static_cast<int>(threadIdx.y);
  // One thread for the tile, and one for each neighbour.
  int woken = -1;
  if (threadIdx.x == 0) woken = tile;
  if (threadIdx.x == 1 && (moving & kWest) != 0 && cells.column_begin > 0) woken = tile - 1;
  if (threadIdx.x == 2 && (moving & kEast) != 0 && cells.column_end < tiles.columns) woken = tile + 1;
  if (threadIdx.x == 3 && row < DueTiles::kReach && cells.row_begin > 0) woken = tile - tiles.across;
  if (threadIdx.x == 4 && row >= kBlockRows - DueTiles::kReach && cells.row_end < tiles.rows)
    woken = tile + tiles.across;
  if (moving != 0 && woken >= 0) tiles.add(woken, step + 1);
  return found.speed;
}

}  // namespace shallow_sand
