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
    // Over all places, whatever is in use: an index that is known to the compiler needs no memory.
    for (int k = 0; k < kMost; ++k) {
      const bool free = k == count;
      if (k > count || !(free || carried.bottom < at[k].bottom)) continue;
      const SolidInterval higher = at[k];
      at[k] = carried;
      if (free) {
        ++count;
        return;
      }
      carried = higher;
    }
    at[kMost - 1].top = maximum(at[kMost - 1].top, carried.top);
  }
};

/// A vertical ray in the frame of a body: where it is at a height above the body's origin, in samples of the
/// body's distance field.
struct RayInField {
  Vector3 base;
  Vector3 rise;  ///< [1/m]

  SHALLOW_SAND_HOST_DEVICE static RayInField at(const BodyView& body, float x, float y) {
    const Vector3 level = body.toBody({x, y, body.position.z});
    const float per_spacing = 1.0f / body.field.spacing;
    return {{(level.x - body.field.origin.x) * per_spacing, (level.y - body.field.origin.y) * per_spacing,
             (level.z - body.field.origin.z) * per_spacing},
            {body.axis_z.x * per_spacing, body.axis_z.y * per_spacing, body.axis_z.z * per_spacing}};
  }

  SHALLOW_SAND_HOST_DEVICE Vector3 placeAt(float height) const {
    return {base.x + height * rise.x, base.y + height * rise.y, base.z + height * rise.z};
  }

  /// Distance to the body's surface at a height. [m]
  SHALLOW_SAND_HOST_DEVICE float sample(const DistanceFieldView& field, float height) const {
    const Vector3 place = placeAt(height);
    return field.sampleAt(place.x, place.y, place.z);
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
    // Along these faces of the box, a ray meets them far away, if at all.
    const float slope = fabsf(rise) < 1e-6f ? 1e-30f : rise;
    const float one = -start / slope;
    const float other = (last - start) / slope;
    low = maximum(low, minimum(one, other));
    high = minimum(high, maximum(one, other));
  }
};

/// A place on a ray through a body.
struct RaySample {
  float z;         ///< height above the body's origin [m]
  float distance;  ///< to the body's surface [m]

  SHALLOW_SAND_HOST_DEVICE bool inside() const { return distance < 0.0f; }
  /// Height of the next sample: as far as no surface can be nearer, but no higher than `to`. [m]
  SHALLOW_SAND_HOST_DEVICE float nextZ(float spacing, float to) const {
    return minimum(z + maximum(spacing, fabsf(distance)), to);
  }
};

/// The solid parts that a march up a ray meets of one body.
struct SolidsOfBody {
  int number;
  float origin;  ///< height of the body's origin [m]

  /// From a sample to the next, of which one is inside of the body: the surface is found by linear
  /// interpolation. `bottom`: where the march came into the body, above its origin [m]
  SHALLOW_SAND_HOST_DEVICE void cross(const RaySample& sample, const RaySample& next, float& bottom,
                                      SolidIntervals& solids) const {
    const float crossing =
        sample.z + (next.z - sample.z) * (sample.distance / (sample.distance - next.distance));
    if (next.inside()) {
      bottom = crossing;
    } else {
      add(bottom, crossing, solids);
    }
  }
  SHALLOW_SAND_HOST_DEVICE void add(float bottom, float top, SolidIntervals& solids) const {
    solids.insert({origin + bottom, origin + top, number});
  }
};

/// Marches up a vertical ray through one body, from `from` on, and adds the solid intervals (section 5, steps
/// 1–3: the body's signed distance field is sampled along the ray; where its sign changes, there is a
/// crossing). [m]
SHALLOW_SAND_HOST_DEVICE inline void castRay(const BodyView& body, int number, float x, float y, float from,
                                             SolidIntervals& solids) {
  const RayInField ray = RayInField::at(body, x, y);
  const SolidsOfBody of_body{number, body.position.z};
  float z = from - body.position.z;
  float to = body.high.z - body.position.z;
  ray.clip(body.field, z, to);
  if (!(z < to)) return;
  float bottom = z;
  RaySample sample{z, body.field.spacing};  // it comes from outside
  RaySample next = sample;
  do {
    next.distance = ray.sample(body.field, next.z);
    if (sample.inside() != next.inside()) of_body.cross(sample, next, bottom, solids);
    sample = next;
    next.z = sample.nextZ(body.field.spacing, to);
  } while (sample.z < to);
  if (sample.inside()) of_body.add(bottom, to, solids);
}

/// Bodies over the bed of a grid, into which a ray is cast up each column.
struct BodiesOverBed {
  BodyBins bins;
  const float* bed;
  int across;     ///< cells in a row
  float spacing;  ///< [m]

  SHALLOW_SAND_HOST_DEVICE long long cellAt(int i, int j) const {
    return static_cast<long long>(j) * across + i;
  }
  /// Where the centre of a cell is, along x or y. [m]
  SHALLOW_SAND_HOST_DEVICE float centre(int cell) const {
    return (static_cast<float>(cell) + 0.5f) * spacing;
  }
};

/// The solid parts of the column of a cell.
SHALLOW_SAND_HOST_DEVICE inline SolidIntervals solidsAt(const BodiesOverBed& bodies, int i, int j) {
  const BodyBins& bins = bodies.bins;
  const float x = bodies.centre(i);
  const float y = bodies.centre(j);
  const float b = bodies.bed[bodies.cellAt(i, j)];
  SolidIntervals solids;
  const int bin = bins.binOf(i, j);
  for (int k = bins.first[bin]; k < bins.first[bin + 1]; ++k) {
    if (bins.apart != nullptr && bins.apart[bins.members[k]] != 0) continue;
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
  for (int k = 1; k < SolidIntervals::kMost; ++k) {
    if (k >= solids.count) break;
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
