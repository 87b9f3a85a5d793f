#include "shallow_sand/particles/grain.h"

namespace shallow_sand {

std::vector<Grain> startingGrains(const GrainGrid& grains, const Grid& grid, const Fields& fields) {
  std::vector<Grain> starting;
  starting.reserve(static_cast<std::size_t>(grains.cells()));
  const float least = bareDepth(grid);
  for (int d = 0; d < grains.layers; ++d) {
    for (int t = 0; t < grains.rows; ++t) {
      for (int s = 0; s < grains.columns; ++s) {
        const std::uint32_t cell = static_cast<std::uint32_t>(starting.size());
        const float depth = fields.allDepth(grid.index(s / grains.per_cell, t / grains.per_cell));
        const bool bare = depth < least || depth < static_cast<float>(d) * grains.spacing;
        starting.push_back(generatedGrain(cell, 0, bare ? cell | Grain::kBare : cell));
      }
    }
  }
  return starting;
}

}  // namespace shallow_sand
