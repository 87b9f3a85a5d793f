#pragma once

#include <cmath>
#include <limits>

#include "shallow_sand/coupling/body_view.h"

namespace shallow_sand {

/// A solid part of a vertical ray. [m]
struct SolidInterval {
  float bottom;
  float top;
};

/// Marches up a vertical ray through one body, from `from` to `to`, and reports the lowest solid interval
/// between them and the length of all solid intervals below `surface` (section 5, steps 1–3: the body's
/// signed distance field is sampled along the ray; where its sign changes, the crossing is found by linear
/// interpolation). [m] `lowest` is left alone if the ray meets nothing.
SHALLOW_SAND_HOST_DEVICE inline float castRay(const BodyView& body, float x, float y, float from, float to,
                                              float surface, SolidInterval& lowest, bool& found) {
  const float shortest = body.field.spacing;
  float z = from;
  float distance = body.field.sample(body.toBody({x, y, z}));
  float bottom = from;
  float submerged = 0.0f;
  found = false;
  while (z < to) {
    const float next_z = minimum(z + maximum(shortest, fabsf(distance)), to);
    const float next = body.field.sample(body.toBody({x, y, next_z}));
    const bool inside = distance < 0.0f;
    const bool next_inside = next < 0.0f;
    if (inside != next_inside) {
      const float crossing = z + (next_z - z) * (distance / (distance - next));
      if (next_inside) {
        bottom = crossing;
      } else {
        if (!found) lowest = {bottom, crossing};
        found = true;
        submerged += maximum(minimum(crossing, surface) - bottom, 0.0f);
      }
    }
    z = next_z;
    distance = next;
  }
  if (distance < 0.0f) {
    if (!found) lowest = {bottom, to};
    found = true;
    submerged += maximum(minimum(to, surface) - bottom, 0.0f);
  }
  return submerged;
}

/// What the rays leave behind, one float a cell.
struct ContactFields {
  float* ceiling;     ///< depth of sand that fits under the lowest solid interval, infinite without one [m]
  float* length;      ///< of that interval within the sand, Ω_s of Eq. 20 [m]
  float* velocity_x;  ///< mean velocity V + ω × r of the body over that length [m/s]
  float* velocity_y;
  float* velocity_z;
  float* overlap;  ///< of all solid intervals within the sand [m]
};

/// Casts the ray of one column through all bodies. Bodies that hang clear above the sand are not seen.
struct CastRays {
  const BodyView* bodies;
  int count;
  const float* depth;
  const float* bed;
  ContactFields contact;
  int columns;
  float spacing;

  SHALLOW_SAND_HOST_DEVICE void operator()(int i, int j) const {
    const long long at = static_cast<long long>(j) * columns + i;
    const float x = (static_cast<float>(i) + 0.5f) * spacing;
    const float y = (static_cast<float>(j) + 0.5f) * spacing;
    const float b = bed[at];
    const float surface = b + depth[at];
    SolidInterval lowest{std::numeric_limits<float>::infinity(), std::numeric_limits<float>::infinity()};
    Vector3 velocity;
    float overlap = 0.0f;
    for (int k = 0; k < count; ++k) {
      const BodyView& body = bodies[k];
      const float from = maximum(b, body.low.z);
      const float to = minimum(body.high.z, surface + spacing);
      if (x < body.low.x || x > body.high.x || y < body.low.y || y > body.high.y || !(from < to)) continue;
      SolidInterval interval{0.0f, 0.0f};
      bool found = false;
      overlap += castRay(body, x, y, from, to, surface, interval, found);
      if (found && interval.bottom < lowest.bottom) {
        lowest = interval;
        // The velocity is linear along the ray: its mean over the interval is its value in the middle.
        velocity = body.velocityAt({x, y, 0.5f * (interval.bottom + minimum(interval.top, surface))});
      }
    }
    contact.ceiling[at] = maximum(lowest.bottom - b, 0.0f);
    contact.length[at] = maximum(minimum(lowest.top, surface) - lowest.bottom, 0.0f);
    contact.velocity_x[at] = velocity.x;
    contact.velocity_y[at] = velocity.y;
    contact.velocity_z[at] = velocity.z;
    contact.overlap[at] = minimum(overlap, depth[at]);
  }
};

/// Largest speed at which a body that is in the sand moves over the map. [m/s]
struct ContactSpeed {
  ContactFields contact;
  int columns;

  SHALLOW_SAND_HOST_DEVICE float operator()(int i, int j) const {
    const long long at = static_cast<long long>(j) * columns + i;
    const float speed = maximum(fabsf(contact.velocity_x[at]), fabsf(contact.velocity_y[at]));
    return contact.length[at] > 0.0f ? speed : 0.0f;
  }
};

}  // namespace shallow_sand
