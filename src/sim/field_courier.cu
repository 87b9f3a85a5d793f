#include <algorithm>

#include "shallow_sand/sim/field_courier.cuh"

namespace shallow_sand {

namespace {

/// Tiles that have changed, one after the other: their numbers, and of each cell of a tile one value after
/// the other.
struct Parcel {
  int* count;
  int* numbers;
  float* values;
};

__device__ void packCell(const FieldSources& sources, long long at, float* values) {
  const bool with_loads = sources.top != nullptr;
  const Sand ground = with_loads ? sources.columns.ground(at) : sources.ground.get(at);
  values[0] = ground.h;
  values[kBlockThreads] = ground.hu;
  values[2 * kBlockThreads] = ground.hv;
  if (!with_loads) return;
  const Sand load = sources.columns.load(at);
  values[3 * kBlockThreads] = load.h;
  values[4 * kBlockThreads] = load.hu;
  values[5 * kBlockThreads] = load.hv;
  values[6 * kBlockThreads] = sources.top[at];
}

__global__ void __launch_bounds__(kBlockThreads, 1)
    packChangedTiles(const DueTiles tiles, const FieldSources sources, const Parcel parcel) {
  __shared__ int place;
  const bool first = threadIdx.x == 0 && threadIdx.y == 0;
  const long long floats = kBlockThreads * (sources.top == nullptr ? 3 : 7);
  for (int tile = static_cast<int>(blockIdx.x); tile < tiles.count; tile += static_cast<int>(gridDim.x)) {
    if (first) {
      place = tiles.changed[tile] != 0 ? atomicAdd(parcel.count, 1) : -1;
      if (place >= 0) parcel.numbers[place] = tile;
      tiles.changed[tile] = 0;
    }
    __syncthreads();
    const int here = place;
    __syncthreads();
    const Window cells = tiles.cellsOf(tile);
    const int i = cells.column_begin + static_cast<int>(threadIdx.x);
    const int j = cells.row_begin + static_cast<int>(threadIdx.y);
    if (here < 0 || !cells.holds(i, j)) continue;
    packCell(sources, static_cast<long long>(j) * tiles.columns + i,
             parcel.values + here * floats + (threadIdx.y * kBlockColumns + threadIdx.x));
  }
}

}  // namespace

FieldCourier::FieldCourier(const Grid& grid, const Fields& fields)
    : grid_(grid),
      tiles_(DueTiles::tilesAcross(grid.columns) * DueTiles::tilesUp(grid.rows)),
      fields_(fields),
      changed_(grid, kBlockColumns, kBlockRows) {
  changed_.add(Window::all(grid));
}

FieldCourier::~FieldCourier() {
  cudaStreamSynchronize(stream_);  // a copy that nobody waited for still uses the memory
}

void FieldCourier::expectLoads() {
  if (!fields_.load.empty()) return;
  collect();
  fields_.addLoads();
  changed_.add(Window::all(grid_));
  values_ = CudaMemory<float>(0);
}

/// Memory is taken by those who ask for fields, and kept.
void FieldCourier::prepare() {
  if (values_.size() > 0) return;
  const std::size_t floats = static_cast<std::size_t>(floatsOfTile());
  const std::size_t at_once = static_cast<std::size_t>(std::min(tiles_, kTilesAtOnce));
  numbers_ = CudaMemory<int>(static_cast<std::size_t>(tiles_));
  values_here_ = PinnedMemory<float>(floats * at_once);
  numbers_here_ = PinnedMemory<int>(at_once);
  values_ = CudaMemory<float>(floats * static_cast<std::size_t>(tiles_));
}

void FieldCourier::request(const DueTiles& tiles, const FieldSources& sources, const CudaStream& stream) {
  collect();
  prepare();
  checkCuda(cudaMemsetAsync(count_.data(), 0, sizeof(int), stream), "clear memory");
  constexpr int kMostBlocks = 1024;
  packChangedTiles<<<static_cast<unsigned>(std::min(tiles_, kMostBlocks)), dim3(kBlockColumns, kBlockRows), 0,
                     stream>>>(tiles, sources, {count_.data(), numbers_.data(), values_.data()});
  checkCuda(cudaGetLastError(), "gather fields");
  gathered_.record(stream);
  gathered_.letWait(stream_);
  checkCuda(cudaMemcpyAsync(count_here_.data(), count_.data(), sizeof(int), cudaMemcpyDeviceToHost, stream_),
            "copy from the GPU");
  requested_ = true;
}

const Fields& FieldCourier::collect() {
  if (!requested_) return fields_;
  stream_.wait("bring fields to the host");
  const int changed = count_here_[0];
  const std::size_t floats = static_cast<std::size_t>(floatsOfTile());
  for (int begin = 0; begin < changed; begin += kTilesAtOnce) {
    const std::size_t count = static_cast<std::size_t>(std::min(changed - begin, kTilesAtOnce));
    checkCuda(cudaMemcpyAsync(numbers_here_.data(), numbers_.data() + begin, count * sizeof(int),
                              cudaMemcpyDeviceToHost, stream_),
              "copy from the GPU");
    checkCuda(cudaMemcpyAsync(values_here_.data(), values_.data() + static_cast<std::size_t>(begin) * floats,
                              count * floats * sizeof(float), cudaMemcpyDeviceToHost, stream_),
              "copy from the GPU");
    stream_.wait("bring fields to the host");
    for (std::size_t k = 0; k < count; ++k) unpack(numbers_here_[k], values_here_.data() + k * floats);
  }
  requested_ = false;
  return fields_;
}

void FieldCourier::unpack(int tile, const float* values) {
  const Window cells = DueTiles::cellsOf(tile, grid_.columns, grid_.rows);
  changed_.add(cells);
  std::vector<float>* const all[] = {
      &fields_.depth,           &fields_.momentum_x,      &fields_.momentum_y,    &fields_.load,
      &fields_.load_momentum_x, &fields_.load_momentum_y, &fields_.load_elevation};
  const int fields = floatsOfTile() / kBlockThreads;
  for (int field = 0; field < fields; ++field) {
    for (int row = 0; row < cells.rows(); ++row) {
      std::copy_n(values + field * kBlockThreads + row * kBlockColumns, cells.columns(),
                  all[field]->data() + grid_.index(cells.column_begin, cells.row_begin + row));
    }
  }
}

}  // namespace shallow_sand
