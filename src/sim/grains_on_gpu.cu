#include <algorithm>

#include "shallow_sand/sim/grains_on_gpu.cuh"

namespace shallow_sand {

namespace {

/// Calls function(i, j) for a window of as many cells as a block has threads, each by a thread.
template <class Function>
__device__ void forEachCell(const Window& cells, const Function& function) {
  const int i = cells.column_begin + static_cast<int>(threadIdx.x);
  const int j = cells.row_begin + static_cast<int>(threadIdx.y);
  if (cells.holds(i, j)) function(i, j);
}

/// Calls function(s, t, d) for the cells of J in a window of cells of I.
template <class Function>
__device__ void forEachGrain(const GrainGrid& grains, const Window& cells, const Function& function) {
  const int n = grains.per_cell;
  for (int d = 0; d < grains.layers; ++d) {
    for (int t = n * cells.row_begin + static_cast<int>(threadIdx.y); t < n * cells.row_end;
         t += kBlockRows) {
      for (int s = n * cells.column_begin + static_cast<int>(threadIdx.x); s < n * cells.column_end;
           s += kBlockColumns)
        function(s, t, d);
    }
  }
}

__device__ Window cellsOf(const TileList& list, int k, const GrainMove& move) {
  return list.cellsOf(k, move.flow.sand.step.columns, move.flow.sand.step.rows);
}

__device__ bool isFirst() { return threadIdx.x == 0 && threadIdx.y == 0; }

__global__ void __launch_bounds__(kBlockThreads, 1)
    findGrainFlow(SHALLOW_SAND_GRID_CONSTANT const GrainMove move,
                  SHALLOW_SAND_GRID_CONSTANT const AwakeCells awake) {
  const int list = DueTiles::listOf(awake.step);
  const int tiles = awake.tiles.lengths[list];
  for (int k = static_cast<int>(blockIdx.x); k < tiles + awake.block_count;
       k += static_cast<int>(gridDim.x)) {
    const Window cells =
        k < tiles ? awake.tiles.cellsOf(awake.tiles.tile(list, k)) : awake.blocks[k - tiles].cells;
    forEachCell(cells, [&](int i, int j) { move.findFlow(i, j); });
  }
}

__global__ void __launch_bounds__(kBlockThreads, 1)
    claimCells(SHALLOW_SAND_GRID_CONSTANT const GrainMove move) {
  const int tiles = *move.moving.length;
  for (int k = static_cast<int>(blockIdx.x); k < tiles; k += static_cast<int>(gridDim.x)) {
    const Window cells = cellsOf(move.moving, k, move);
    if (isFirst()) move.reached.add(cells.column_begin, cells.row_begin);
    forEachGrain(move.flow.grains, cells, [&](int s, int t, int d) { move.claim(s, t, d); });
  }
}

__global__ void __launch_bounds__(kBlockThreads, 1)
    settleGrains(SHALLOW_SAND_GRID_CONSTANT const GrainMove move) {
  const int tiles = *move.reached.length;
  for (int k = static_cast<int>(blockIdx.x); k < tiles; k += static_cast<int>(gridDim.x)) {
    const bool moves = move.moving.holds(move.reached.tiles[k]);
    forEachGrain(move.flow.grains, cellsOf(move.reached, k, move),
                 [&](int s, int t, int d) { move.settle(s, t, d, moves); });
  }
}

__global__ void __launch_bounds__(kBlockThreads, 1)
    finishMove(SHALLOW_SAND_GRID_CONSTANT const GrainMove move) {
  const int tiles = *move.reached.length;
  for (int k = static_cast<int>(blockIdx.x); k < tiles; k += static_cast<int>(gridDim.x)) {
    const Window cells = cellsOf(move.reached, k, move);
    forEachGrain(move.flow.grains, cells, [&](int s, int t, int d) { move.finish(s, t, d); });
    forEachCell(cells, [&](int i, int j) { move.clearFlow(i, j); });
    if (!isFirst()) continue;
    move.moving.remove(move.reached.tiles[k]);
    move.reached.remove(move.reached.tiles[k]);
  }
}

}  // namespace

void moveGrains(const GrainMove& move, const AwakeCells& awake, const CudaStream& stream) {
  constexpr int kMostBlocks = 1024;
  const dim3 block(kBlockColumns, kBlockRows);
  const unsigned blocks =
      static_cast<unsigned>(std::min(std::max(awake.tiles.count, awake.block_count), kMostBlocks));
  for (const TileList* list : {&move.moving, &move.reached})
    checkCuda(cudaMemsetAsync(list->length, 0, sizeof(int), stream), "clear memory");
  findGrainFlow<<<blocks, block, 0, stream>>>(move, awake);
  claimCells<<<blocks, block, 0, stream>>>(move);
  settleGrains<<<blocks, block, 0, stream>>>(move);
  finishMove<<<blocks, block, 0, stream>>>(move);
  checkCuda(cudaGetLastError(), "move grains");
}

}  // namespace shallow_sand
