#pragma once

#include <cstring>

#include "random_fields.h"
#include "shallow_sand/particles/grains.h"

namespace shallow_sand {

/// At most `most` grains a cell of the map.
inline GrainParameters randomGrains(std::mt19937& random, int most) {
  GrainParameters grains;
  grains.per_cell = randomCount(random, 1, static_cast<int>(std::sqrt(most)));
  grains.layers = randomCount(random, 1, most / (grains.per_cell * grains.per_cell));
  grains.speed = random() % 2 == 0 ? GrainSpeed::mean : GrainSpeed::dilute;
  grains.color = random() % 2 == 0 ? GrainColor::origin : GrainColor::layer;
  return grains;
}

inline bool sameBits(const std::vector<Grain>& a, const std::vector<Grain>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Grain)) == 0;
}

/// How many grains are not where they were.
inline std::size_t countMoved(const std::vector<Grain>& a, const std::vector<Grain>& b) {
  std::size_t moved = 0;
  for (std::size_t k = 0; k < a.size(); ++k) moved += std::memcmp(&a[k], &b[k], sizeof(Grain)) != 0 ? 1 : 0;
  return moved;
}

/// Every cell holds a grain (Eq. 30) of its own layer (Eq. 32).
inline void expectValid(const Grains& grains) {
  const std::size_t of_layer = static_cast<std::size_t>(grains.grid.columns) * grains.grid.rows;
  ASSERT_EQ(grains.cells.size(), of_layer * grains.grid.layers);
  for (std::size_t k = 0; k < grains.cells.size(); ++k) {
    const Grain& grain = grains.cells[k];
    ASSERT_TRUE(grain.x >= 0.0f && grain.x < 1.0f && grain.y >= 0.0f && grain.y < 1.0f)
        << grain.x << ", " << grain.y;
    ASSERT_EQ((grain.origin & ~Grain::kBare) / of_layer, k / of_layer);
    ASSERT_LE(grain.born, grains.moves);
  }
}

}  // namespace shallow_sand
