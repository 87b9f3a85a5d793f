#pragma once

#include "shallow_sand/coupling/contact.h"
#include "shallow_sand/coupling/rays.h"

namespace shallow_sand {

/// Tells apart what of a column's sand lies under its lowest solid and what lies on it, after a ray was cast
/// through all bodies as they stand now. Of sand into which a body has come,
/// - all that stands above its underside lies on it, if the body is buried deeper than it is high: a plate
///   that moves through sand lifts what is above it;
/// - else what stands above its upper side lies on it, and what is too much under it stays there for
///   DisplaceSand to push aside: sand runs over a low blade, and is pushed before it.
/// A load rises and sinks with its solid, unless that rises at once by more than a cell and over the load:
/// then a wall has come, and sweeps the load. Where no solid is left, the load falls on the ground.
struct MeetBodies : BodiesOverBed {
  SandColumns columns;
  ContactFields contact;
  SandLayer ground;  ///< what the column's ground is now
  SandLayer load;

  SHALLOW_SAND_HOST_DEVICE void operator()(int i, int j, const SolidIntervals& solids) const {
    const float old_top = contact.top[cellAt(i, j)];
    record(lowestSolid(solids, spacing), i, j);
    meet(i, j, old_top);
  }

  /// Bodies stand where they stood the last time, only sand has moved.
  SHALLOW_SAND_HOST_DEVICE void operator()(int i, int j) const { meet(i, j, contact.top[cellAt(i, j)]); }

  /// Nothing has moved but sand that had no room: columns that hold no such sand stay as they are.
  SHALLOW_SAND_HOST_DEVICE void again(int i, int j) const {
    const long long at = cellAt(i, j);
    const Sand below = columns.ground(at);
    const Sand above = columns.load(at);
    if (below.h > contact.clearance[at] || above.h > contact.headroom[at]) return (*this)(i, j);
    contact.swept[at] = 0;
    ground.set(at, below);
    load.set(at, above);
  }

 private:
  SHALLOW_SAND_HOST_DEVICE void meet(int i, int j, float old_top) const {
    const long long at = cellAt(i, j);
    const float b = bed[at];
    Sand below = columns.ground(at);
    Sand above = columns.load(at);
    const bool had_load = above.h > 0.0f;
    const float surface = b + below.h;
    const float clearance = contact.clearance[at];
    const float top = contact.top[at];
    if (!contact.isCovered(at)) {
      below = sumOf(below, above);
      above = {};
    } else if (columns.cover[at] != Cover::touching && below.h > clearance && surface > top) {
      const bool buried = surface - top >= (top - b) - clearance;
      lift(below, above, buried ? clearance : top - b);
    }
    const bool wall_came = top - old_top > spacing && top > old_top + above.h;
    contact.swept[at] = had_load && wall_came ? 1 : 0;
    contact.length[at] = maximum(minimum(top, surface) - (b + clearance), 0.0f);
    ground.set(at, below);
    load.set(at, above);
  }

  SHALLOW_SAND_HOST_DEVICE void record(const LowestSolid& solid, int i, int j) const {
    const long long at = cellAt(i, j);
    contact.clearance[at] = maximum(solid.bottom - bed[at], 0.0f);
    contact.top[at] = solid.top;
    contact.headroom[at] = solid.next - solid.top;
    contact.body[at] = -1;
    contact.velocity_x[at] = 0.0f;
    contact.velocity_y[at] = 0.0f;
    contact.velocity_z[at] = 0.0f;
    if (solid.lowest_body < 0) return;
    const float surface = bed[at] + columns.ground(at).h;
    const bool submerged = surface > solid.bottom;
    const BodyView& body = bins.bodies[submerged ? solid.lowest_body : solid.highest_body];
    // The velocity is linear along the ray: its mean over the interval is its value in the middle.
    const float z = submerged ? 0.5f * (solid.bottom + minimum(solid.top, surface)) : solid.top;
    const Vector3 velocity = body.velocityAt({centre(i), centre(j), z});
    contact.body[at] = body.number;
    contact.velocity_x[at] = velocity.x;
    contact.velocity_y[at] = velocity.y;
    contact.velocity_z[at] = velocity.z;
  }

  /// All of the ground's sand that is deeper than `kept` becomes load.
  SHALLOW_SAND_HOST_DEVICE static void lift(Sand& below, Sand& above, float kept) {
    const float lifted = below.h - kept;
    const float part = lifted / below.h;
    above = {above.h + lifted, above.hu + part * below.hu, above.hv + part * below.hv};
    below = {kept, below.hu - part * below.hu, below.hv - part * below.hv};
  }
};

/// See MeetBodies::again.
struct MeetBodiesAgain {
  MeetBodies meet;

  SHALLOW_SAND_HOST_DEVICE void operator()(int i, int j) const { meet.again(i, j); }
};

/// Depth of the sand inside of bodies, of one column. [m]
struct MeasureOverlap : BodiesOverBed {
  SandColumns columns;
  const float* top;
  float* overlap;

  SHALLOW_SAND_HOST_DEVICE void operator()(int i, int j, const SolidIntervals& solids) const {
    const long long at = cellAt(i, j);
    const float b = bed[at];
    const float ground = columns.ground(at).h;
    const float load = columns.load(at).h;
    float sum = 0.0f;
    float reached = b;
    for (int k = 0; k < SolidIntervals::kMost; ++k) {
      if (k >= solids.count) break;
      const float bottom = maximum(solids.at[k].bottom, reached);
      const float end = maximum(solids.at[k].top, reached);
      sum += maximum(minimum(end, b + ground) - bottom, 0.0f);
      sum += maximum(minimum(end, top[at] + load) - maximum(bottom, top[at]), 0.0f);
      reached = end;
    }
    overlap[at] = minimum(sum, ground + load);
  }
};

}  // namespace shallow_sand
