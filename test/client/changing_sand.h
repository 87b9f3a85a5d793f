#pragma once

#include <string>

#include "random_fields.h"
#include "shallow_sand/HeightField.h"
#include "shallow_sand/device/tile_set.h"
#include "shallow_sand/ros/fields_change.h"
#include "shallow_sand/solver/equations.h"
#include "shallow_sand/solver/sand_constants.h"

namespace shallow_sand {

inline float randomValue(std::mt19937& random) {
  const float values[] = {0.0f, -0.0f, 1e-42f, static_cast<float>(uniform(random, 0.0, 2.0))};
  return values[random() % 4];
}

inline Window randomWindow(std::mt19937& random, const Grid& grid, int longest) {
  const int i = randomCount(random, 0, grid.columns - 1);
  const int j = randomCount(random, 0, grid.rows - 1);
  return {i, j, std::min(grid.columns, i + randomCount(random, 1, longest)),
          std::min(grid.rows, j + randomCount(random, 1, longest))};
}

/// Fields that change here and there as no sand does, in windows that are known.
struct ChangingSand {
  ChangingSand(std::mt19937& random, int most_cells) {
    grid.columns = randomCount(random, 1, most_cells);
    grid.rows = randomCount(random, 1, most_cells);
    grid.spacing = 0.05f;
    grid.origin_x = uniform(random, -10.0, 10.0);
    constants = sandConstants(grid, {0.0, 0.0, -9.81}, Material());
    for (std::vector<float>* values : {&fields.bed, &fields.depth, &fields.momentum_x, &fields.momentum_y}) {
      values->resize(grid.cells());
      for (float& value : *values) value = randomValue(random);
    }
  }

  FieldsChange whole() const { return changeOf(fields, {Window::all(grid)}, grid); }

  /// Changes some cells; most windows have more cells than those that change.
  FieldsChange change(std::mt19937& random) {
    if (fields.load.empty() && random() % 8 == 0) {
      fields.addLoads();
      return whole();
    }
    TileSet tiles(grid, randomCount(random, 1, 40), randomCount(random, 1, 40));
    const int windows = randomCount(random, 0, 4);
    for (int k = 0; k < windows; ++k) {
      const Window window = randomWindow(random, grid, 50);
      tiles.add(window);
      const unsigned sparse = 1 + random() % 100;
      for (int j = window.row_begin; j < window.row_end; ++j) {
        for (int i = window.column_begin; i < window.column_end; ++i) {
          if (random() % sparse == 0) changeCell(random, grid.index(i, j));
        }
      }
    }
    return changeOf(fields, tiles.take(), grid);
  }

  void changeCell(std::mt19937& random, std::size_t k) {
    std::vector<std::vector<float>*> lists{&fields.depth, &fields.momentum_x, &fields.momentum_y};
    if (!fields.load.empty()) lists.insert(lists.end(), {&fields.load, &fields.load_elevation});
    (*lists[random() % lists.size()])[k] = randomValue(random);
  }

  float speed(std::size_t k) const {
    return inverseDepth(fields.depth[k], constants) * std::hypot(fields.momentum_x[k], fields.momentum_y[k]);
  }

  Grid grid;
  SandConstants constants;
  Fields fields;
};

/// A map is the sand, to the bit.
inline void expectIs(const HeightField& map, const ChangingSand& sand, bool with_speed) {
  EXPECT_EQ(map.columns, static_cast<std::uint32_t>(sand.grid.columns));
  EXPECT_EQ(map.rows, static_cast<std::uint32_t>(sand.grid.rows));
  EXPECT_EQ(map.spacing, sand.grid.spacing);
  EXPECT_EQ(map.origin_x, sand.grid.origin_x);
  EXPECT_EQ(map.origin_y, sand.grid.origin_y);
  EXPECT_TRUE(sameBits(map.bed, sand.fields.bed));
  EXPECT_TRUE(sameBits(map.depth, sand.fields.depth));
  EXPECT_TRUE(sameBits(map.load, sand.fields.load));
  EXPECT_TRUE(sameBits(map.load_elevation, sand.fields.load_elevation));
  std::vector<float> speeds;
  for (std::size_t k = 0; with_speed && k < sand.grid.cells(); ++k) speeds.push_back(sand.speed(k));
  EXPECT_TRUE(sameBits(map.speed, speeds));
}

}  // namespace shallow_sand
