#pragma once

#include "random_fields.h"

namespace shallow_sand {

/// Of any kind, centred on the grid; up to twelve cells wide.
inline Edit randomEdit(std::mt19937& random, const Grid& grid) {
  Edit edit;
  edit.region.shape = random() % 2 == 0 ? Region::Shape::disc : Region::Shape::rectangle;
  const double width = grid.columns * static_cast<double>(grid.spacing);
  const double height = grid.rows * static_cast<double>(grid.spacing);
  edit.region.center = {grid.origin_x + uniform(random, 0.0, width),
                        grid.origin_y + uniform(random, 0.0, height)};
  edit.region.radius = uniform(random, 0.1, 8.0) * grid.spacing;
  edit.region.size = {uniform(random, 0.1, 12.0) * grid.spacing, uniform(random, 0.1, 12.0) * grid.spacing};
  edit.operation = static_cast<EditOperation>(random() % 4);
  edit.value = uniform(random, 0.0, 5.0) * grid.spacing;
  return edit;
}

}  // namespace shallow_sand
