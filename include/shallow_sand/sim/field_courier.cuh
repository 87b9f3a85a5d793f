#pragma once

#include "shallow_sand/core/fields.h"
#include "shallow_sand/coupling/contact.h"
#include "shallow_sand/device/cuda_memory.cuh"
#include "shallow_sand/device/tile_set.h"
#include "shallow_sand/solver/due_tiles.cuh"

namespace shallow_sand {

/// Where the fields of the sand are on the GPU.
struct FieldSources {
  SandLayer ground;     ///< of a map without bodies
  SandColumns columns;  ///< of one with bodies
  const float* top;     ///< what loads lie on [m]; null without bodies
};

/// Brings the fields to the host: gathers the tiles that have changed, in the stream in which the sand moves,
/// and copies them through pinned memory in a stream of its own, while the sand goes on.
class FieldCourier {
 public:
  FieldCourier(const Grid& grid, const Fields& fields);
  ~FieldCourier();

  /// From now on there are loads, too.
  void expectLoads();
  /// The GPU has other fields now: all tiles have changed, and so has the bed, which never leaves.
  void reset(const Fields& fields) {
    collect();
    fields_ = fields;
    changed_.add(Window::all(grid_));
  }
  /// Gathers what has changed after all that was put into the stream before.
  void request(const DueTiles& tiles, const FieldSources& sources, const CudaStream& stream);
  /// Waits for what was requested.
  const Fields& collect();
  /// Where what was collected has changed since this was asked the last time.
  std::vector<Window> takeChanges() { return changed_.take(); }

 private:
  static constexpr int kTilesAtOnce = 2048;
  int floatsOfTile() const { return kBlockThreads * (fields_.load.empty() ? 3 : 7); }
  void prepare();
  void unpack(int tile, const float* values);

  Grid grid_;
  int tiles_;
  Fields fields_;
  TileSet changed_;
  bool requested_ = false;
  CudaStream stream_;
  CudaEvent gathered_;
  CudaMemory<int> count_{1};
  CudaMemory<int> numbers_{0};
  CudaMemory<float> values_{0};
  PinnedMemory<int> count_here_{1};
  PinnedMemory<int> numbers_here_{0};
  PinnedMemory<float> values_here_{0};
};

}  // namespace shallow_sand
