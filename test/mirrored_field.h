#pragma once

#include <cstddef>

#include "shallow_sand/bodies/distance_field.h"

namespace shallow_sand {

/// One half of a field along an axis (0: x, 1: y) becomes the mirror image of the other. Far from a surface a
/// distance is only a lower bound, and samples on the very surface are inside or outside by a rounding: not
/// alike on both sides.
inline DistanceField mirroredField(DistanceField field, std::size_t axis) {
  const auto count = [&](std::size_t k) { return static_cast<std::size_t>(field.samples[k]); };
  const std::size_t stride = axis == 0 ? 1 : count(0);
  for (std::size_t at = 0; at < field.distance.size(); ++at) {
    const std::size_t place = at / stride % count(axis);
    const std::size_t opposite = count(axis) - 1 - place;
    if (place > opposite) field.distance[at] = field.distance[at - (place - opposite) * stride];
  }
  return field;
}

}  // namespace shallow_sand
