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

/// Depths or surfaces for some of the cells.
inline CellValues randomCellValues(std::mt19937& random, const Grid& grid, EditOperation operation) {
  CellValues cells{std::vector<float>(grid.cells()), std::vector<std::uint8_t>(grid.cells())};
  const unsigned share = 1 + random() % 4;
  const double least = operation == EditOperation::set ? 0.0 : -3.0;
  for (std::size_t k = 0; k < grid.cells(); ++k) {
    cells.given[k] = random() % share == 0 ? 1 : 0;
    // What is not given may be anything.
    cells.values[k] =
        cells.given[k] == 0 ? std::nanf("") : static_cast<float>(uniform(random, least, 5.0) * grid.spacing);
  }
  return cells;
}

}  // namespace shallow_sand
