#pragma once

#include <limits>

#include "shallow_sand/coupling/given_momentum.h"
#include "shallow_sand/coupling/rays.h"

namespace shallow_sand {

/// Eq. 25 and 26 for one column of the paper's coupling, in which sand does not make way: the length of what
/// bodies fill of its sand, Ω_s of Eq. 20, and their mean velocity over it. It counts as that of the body
/// that fills most.
struct FindSubmerged : BodiesOverBed {
  const float* depth;
  ContactFields contact;  ///< length, velocity and body are written

  SHALLOW_SAND_HOST_DEVICE void operator()(int i, int j, const SolidIntervals& solids) const {
    const long long at = cellAt(i, j);
    const float x = centre(i);
    const float y = centre(j);
    const float surface = bed[at] + depth[at];
    float length = 0.0f;
    float longest = 0.0f;
    int body = -1;
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
      if (top - bottom > longest) {
        longest = top - bottom;
        body = bins.bodies[solids.at[k].body].number;
      }
      sum = {sum.x + (top - bottom) * velocity.x, sum.y + (top - bottom) * velocity.y,
             sum.z + (top - bottom) * velocity.z};
      reached = top;
    }
    contact.clearance[at] = std::numeric_limits<float>::infinity();
    contact.length[at] = length;
    contact.body[at] = body;
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
  GivenInWindow given;  ///< is written; the outermost cells of its window are clear of bodies or at the edge
                        ///< of the grid

  SHALLOW_SAND_HOST_DEVICE void operator()(int i, int j) const {
    const long long at = static_cast<long long>(j) * across + i;
    GivenMomentum got{};
    Sand own = sand.get(at);
    if (own.h > 0.0f) {
      const float solid = minimum(contact.length[at], own.h);
      const float loose = (own.h - solid) / own.h;
      const Momentum before{own.hu, own.hv};
      own.hu = solid * contact.velocity_x[at] + loose * own.hu;
      own.hv = solid * contact.velocity_y[at] + loose * own.hv;
      got.own = {own.hu - before.x, own.hv - before.y};
      VerticalPush{contact, sand.depth, across, spacing, given.window}(i, j, own, got);
      sand.set(at, own);
    }
    given.set(i, j, got);
  }
};

}  // namespace shallow_sand
