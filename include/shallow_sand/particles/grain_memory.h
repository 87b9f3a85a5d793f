#pragma once

#include <cstdint>
#include <vector>

#include "shallow_sand/particles/grain_move.h"

namespace shallow_sand {

/// The grains of a map and what a move of them needs, on the memory of a backend: 40 bytes a grain.
template <template <class> class Memory>
class GrainMemory {
 public:
  GrainMemory(const GrainParameters& parameters, const Grid& grid, const std::vector<Grain>& grains)
      : grid_(parameters, grid),
        speed_(parameters.speed),
        across_(TileList::tilesAlong(grid.columns, kBlockColumns)),
        tiles_(static_cast<std::size_t>(across_) * TileList::tilesAlong(grid.rows, kBlockRows)),
        grains_(grains.size()),
        next_(grains.size()),
        claims_(grains.size()),
        u_(grid.cells()),
        v_(grid.cells()),
        listed_(2 * tiles_),
        lists_(2 * tiles_),
        lengths_(2) {
    set(grains);
  }

  void set(const std::vector<Grain>& grains) { grains_.upload(grains.data(), grains.size()); }
  std::vector<Grain> get() const {
    std::vector<Grain> grains(grains_.size());
    grains_.download(grains.data(), grains.size());
    return grains;
  }

  /// A move in this time [s]. The lists of tiles may hold others yet.
  GrainMove move(const VisibleSand& sand, float duration, std::uint32_t number) {
    const auto list = [&](std::size_t k) {
      return TileList{across_, listed_.data() + k * tiles_, lists_.data() + k * tiles_, lengths_.data() + k};
    };
    const GrainFlow flow{grid_,
                         sand,
                         u_.data(),
                         v_.data(),
                         speed_,
                         duration / grid_.spacing,
                         1.0f / static_cast<float>(grid_.per_cell)};
    return {flow,           u_.data(), v_.data(), grains_.data(), next_.data(),
            claims_.data(), list(0),   list(1),   number};
  }

 private:
  GrainGrid grid_;
  GrainSpeed speed_;
  int across_;
  std::size_t tiles_;
  Memory<Grain> grains_;
  Memory<Grain> next_;
  Memory<Claim> claims_;
  Memory<float> u_;
  Memory<float> v_;
  Memory<int> listed_;
  Memory<int> lists_;
  Memory<int> lengths_;
};

}  // namespace shallow_sand
