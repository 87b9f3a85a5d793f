#pragma once

#include <limits>

#include "shallow_sand/coupling/contact.h"
#include "shallow_sand/coupling/rays.h"

namespace shallow_sand {

/// Eq. 25 and 26 for one column of the paper's coupling, in which sand does not make way: the length of what
/// bodies fill of its sand, Ω_s of Eq. 20, and their mean velocity over it.
struct FindSubmerged : BodiesOverBed {
  const float* depth;
  ContactFields contact;  ///< length and velocity are written

  SHALLOW_SAND_HOST_DEVICE void operator()(int i, int j, const SolidIntervals& solids) const {
    const long long at = cellAt(i, j);
    const float x = centre(i);
    const float y = centre(j);
    const float surface = bed[at] + depth[at];
    float length = 0.0f;
    Vector3 sum;
    float reached = bed[at];
    for (int k = 0; k < SolidIntervals::kMost; ++k) {
      if (k >= solids.count) break;
      const float bottom = maximum(solids.at[k].bottom, reached);
      const float top = minimum(solids.at[k].top, surface);
      if (!(top > bottom)) continue;
      // The velocity is linear along the ray: its mean over the interval is its value in the middle.
      const Vector3 velocity = bins.bodies[solids.at[k].body].velocityAt({x, y, 0.5f * (bottom + top)});
      length += top - bottom;
      sum = {sum.x + (top - bottom) * velocity.x, sum.y + (top - bottom) * velocity.y,
             sum.z + (top - bottom) * velocity.z};
      reached = top;
    }
    contact.clearance[at] = std::numeric_limits<float>::infinity();
    contact.length[at] = length;
    contact.velocity_x[at] = length > 0.0f ? sum.x / length : 0.0f;
    contact.velocity_y[at] = length > 0.0f ? sum.y / length : 0.0f;
    contact.velocity_z[at] = length > 0.0f ? sum.z / length : 0.0f;
  }
};

/// Eq. 20 and 24: the part of the sand in which a body is moves with it at once. Does not keep sand out of
/// bodies.
struct DragSand {
  ContactFields contact;
  SandLayer sand;  ///< its momentum is written
  int across;      ///< cells in a row
  float spacing;
  Window window;  ///< its outermost cells are clear of bodies or at the edge of the grid

  SHALLOW_SAND_HOST_DEVICE float verticalVelocity(int i, int j) const {
    if (!window.holds(i, j)) return 0.0f;
    const long long at = static_cast<long long>(j) * across + i;
    return meanVerticalVelocity(contact.length[at], contact.velocity_z[at], sand.depth[at]);
  }

  SHALLOW_SAND_HOST_DEVICE void operator()(int i, int j) const {
    const long long at = static_cast<long long>(j) * across + i;
    Sand own = sand.get(at);
    if (!(own.h > 0.0f)) return;
    const float solid = minimum(contact.length[at], own.h);
    const float loose = (own.h - solid) / own.h;
    own.hu = solid * contact.velocity_x[at] + loose * own.hu;
    own.hv = solid * contact.velocity_y[at] + loose * own.hv;
    // As Eq. 23 has it, hu takes the difference along x only, hv the one along y only.
    own.hu = pushedAside(own.hu, own.h, verticalVelocity(i + 1, j) - verticalVelocity(i - 1, j), spacing);
    own.hv = pushedAside(own.hv, own.h, verticalVelocity(i, j + 1) - verticalVelocity(i, j - 1), spacing);
    sand.set(at, own);
  }
};

}  // namespace shallow_sand
