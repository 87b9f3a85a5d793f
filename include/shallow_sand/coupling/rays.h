#pragma once

#include <cmath>
#include <limits>

#include "shallow_sand/coupling/body_bins.h"

namespace shallow_sand {

/// A solid part of a vertical ray. [m]
struct SolidInterval {
  float bottom;
  float top;
  int body;
};

/// The solid parts of a ray, by their undersides; they may overlap. Of more than there is room for, the
/// highest ones are one.
struct SolidIntervals {
  static constexpr int kMost = 8;
  SolidInterval at[kMost];
  int count = 0;

  SHALLOW_SAND_HOST_DEVICE void insert(const SolidInterval& interval) {
    SolidInterval carried = interval;
    for (int k = 0; k < count; ++k) {
      if (!(carried.bottom < at[k].bottom)) continue;
      const SolidInterval higher = at[k];
      at[k] = carried;
      carried = higher;
    }
    if (count < kMost) {
      at[count++] = carried;
    } else {
      at[kMost - 1].top = maximum(at[kMost - 1].top, carried.top);
    }
  }
};

/// A vertical ray in the frame of a body: where it is at a height above the body's origin, in samples of the
/// body's distance field.
struct RayInField {
  Vector3 base;
  Vector3 rise;  ///< [1/m]

  SHALLOW_SAND_HOST_DEVICE RayInField(const BodyView& body, float x, float y) {
    const Vector3 level = body.toBody({x, y, body.position.z});
    const float per_spacing = 1.0f / body.field.spacing;
    base = {(level.x - body.field.origin.x) * per_spacing, (level.y - body.field.origin.y) * per_spacing,
            (level.z - body.field.origin.z) * per_spacing};
    rise = {body.axis_z.x * per_spacing, body.axis_z.y * per_spacing, body.axis_z.z * per_spacing};
  }

  /// Distance to the body's surface at a height. [m]
  SHALLOW_SAND_HOST_DEVICE float sample(const DistanceFieldView& field, float height) const {
    return field.sampleAt(base.x + height * rise.x, base.y + height * rise.y, base.z + height * rise.z);
  }

  /// Keeps of the heights from `low` to `high` those at which the ray is within the field's box.
  SHALLOW_SAND_HOST_DEVICE void clip(const DistanceFieldView& field, float& low, float& high) const {
    clip(base.x, rise.x, field.samples_x, low, high);
    clip(base.y, rise.y, field.samples_y, low, high);
    clip(base.z, rise.z, field.samples_z, low, high);
  }

 private:
  SHALLOW_SAND_HOST_DEVICE static void clip(float start, float rise, int samples, float& low, float& high) {
    const float last = static_cast<float>(samples - 1);
    if (fabsf(rise) < 1e-6f) {
      if (start < 0.0f || start > last) high = low;
      return;
    }
    const float one = -start / rise;
    const float other = (last - start) / rise;
    low = maximum(low, minimum(one, other));
    high = minimum(high, maximum(one, other));
  }
};

/// Marches up a vertical ray through one body, from `from` on, and adds the solid intervals (section 5, steps
/// 1–3: the body's signed distance field is sampled along the ray; where its sign changes, the crossing is
/// found by linear interpolation). [m]
SHALLOW_SAND_HOST_DEVICE inline void castRay(const BodyView& body, int number, float x, float y, float from,
                                             SolidIntervals& solids) {
  const RayInField ray(body, x, y);
  const float origin = body.position.z;
  const float shortest = body.field.spacing;
  float z = from - origin;
  float to = body.high.z - origin;
  ray.clip(body.field, z, to);
  if (!(z < to)) return;
  float distance = ray.sample(body.field, z);
  float bottom = z;
  while (z < to) {
    const float next_z = minimum(z + maximum(shortest, fabsf(distance)), to);
    const float next = ray.sample(body.field, next_z);
    const bool inside = distance < 0.0f;
    const bool next_inside = next < 0.0f;
    if (inside != next_inside) {
      const float crossing = z + (next_z - z) * (distance / (distance - next));
      if (next_inside) {
        bottom = crossing;
      } else {
        solids.insert({origin + bottom, origin + crossing, number});
      }
    }
    z = next_z;
    distance = next;
  }
  if (distance < 0.0f) solids.insert({origin + bottom, origin + to, number});
}

/// The solid parts of the column of a cell, above a bed of elevation `b` [m].
SHALLOW_SAND_HOST_DEVICE inline SolidIntervals solidsAt(const BodyBins& bins, int i, int j, float spacing,
                                                        float b) {
  const float x = (static_cast<float>(i) + 0.5f) * spacing;
  const float y = (static_cast<float>(j) + 0.5f) * spacing;
  SolidIntervals solids;
  const int bin = bins.binOf(i, j);
  for (int k = bins.first[bin]; k < bins.first[bin + 1]; ++k) {
    const BodyView& body = bins.bodies[bins.members[k]];
    const float from = maximum(b, body.low.z);
    if (x < body.low.x || x > body.high.x || y < body.low.y || y > body.high.y || !(from < body.high.z))
      continue;
    castRay(body, bins.members[k], x, y, from, solids);
  }
  return solids;
}

/// The lowest solid of a column: the lowest interval and all that follow it closer than a cell. [m]
struct LowestSolid {
  float bottom = std::numeric_limits<float>::infinity();
  float top = 0.0f;
  float next = std::numeric_limits<float>::infinity();  ///< underside of the next solid
  int lowest_body = -1;  ///< body of the underside; negative: there is no solid
  int highest_body = -1;
};

SHALLOW_SAND_HOST_DEVICE inline LowestSolid lowestSolid(const SolidIntervals& solids, float spacing) {
  LowestSolid solid;
  if (solids.count == 0) return solid;
  solid.bottom = solids.at[0].bottom;
  solid.top = solids.at[0].top;
  solid.lowest_body = solids.at[0].body;
  solid.highest_body = solids.at[0].body;
  for (int k = 1; k < solids.count; ++k) {
    const SolidInterval& interval = solids.at[k];
    if (interval.bottom - solid.top >= spacing) {
      solid.next = interval.bottom;
      break;
    }
    if (interval.top > solid.top) solid.highest_body = interval.body;
    solid.top = maximum(solid.top, interval.top);
  }
  return solid;
}

}  // namespace shallow_sand
