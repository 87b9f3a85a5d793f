#pragma once

#include "shallow_sand/coupling/contact.h"
#include "shallow_sand/coupling/rays.h"

namespace shallow_sand {

/// Casts the ray of one column through all bodies as they stand now, and tells apart what of its sand lies
/// under the lowest solid and what lies on it. Of sand into which a body has come,
/// - all that stands above its underside lies on it, if the body is buried deeper than it is high: a plate
///   that moves through sand lifts what is above it;
/// - else what stands above its upper side lies on it, and what is too much under it stays there for
///   DisplaceSand to push aside: sand runs over a low blade, and is pushed before it.
/// A load rises and sinks with its solid, unless that rises at once by more than a cell and over the load:
/// then a wall has come, and sweeps the load. Where no solid is left, the load falls on the ground.
struct MeetBodies {
  BodyBins bins;
  SandColumns columns;
  ContactFields contact;
  const float* bed;
  SandLayer ground;  ///< what the column's ground is now
  SandLayer load;
  int across;  ///< cells in a row
  float spacing;

  SHALLOW_SAND_HOST_DEVICE void operator()(int i, int j) const {
    const long long at = static_cast<long long>(j) * across + i;
    const float b = bed[at];
    Sand below = columns.ground(at);
    Sand above = columns.load(at);
    const LowestSolid solid = lowestSolid(solidsAt(bins, i, j, spacing, b), spacing);
    const bool was_closed = columns.cover[at] == Cover::touching;
    const float old_surface_of_load = contact.top[at] + above.h;
    const bool rises_over_a_cell = solid.top - contact.top[at] > spacing;
    const bool had_load = above.h > 0.0f;
    const float clearance = maximum(solid.bottom - b, 0.0f);
    const float surface = b + below.h;
    if (solid.lowest_body < 0) {
      below = {below.h + above.h, below.hu + above.hu, below.hv + above.hv};
      above = {};
    } else if (!was_closed && below.h > clearance && surface > solid.top) {
      const bool buried = surface - solid.top >= solid.top - solid.bottom;
      lift(below, above, buried ? clearance : solid.top - b);
    }
    contact.clearance[at] = clearance;
    contact.top[at] = solid.top;
    contact.headroom[at] = solid.next - solid.top;
    contact.swept[at] = had_load && rises_over_a_cell && solid.top > old_surface_of_load ? 1 : 0;
    contact.length[at] = maximum(minimum(solid.top, surface) - solid.bottom, 0.0f);
    const Vector3 velocity = velocityOf(solid, i, j, surface);
    contact.velocity_x[at] = velocity.x;
    contact.velocity_y[at] = velocity.y;
    contact.velocity_z[at] = velocity.z;
    ground.set(at, below);
    load.set(at, above);
  }

 private:
  /// All of the ground's sand that is deeper than `kept` becomes load.
  SHALLOW_SAND_HOST_DEVICE static void lift(Sand& below, Sand& above, float kept) {
    const float lifted = below.h - kept;
    const float part = lifted / below.h;
    above = {above.h + lifted, above.hu + part * below.hu, above.hv + part * below.hv};
    below = {kept, below.hu - part * below.hu, below.hv - part * below.hv};
  }

  SHALLOW_SAND_HOST_DEVICE Vector3 velocityOf(const LowestSolid& solid, int i, int j, float surface) const {
    if (solid.lowest_body < 0) return {};
    const float x = (static_cast<float>(i) + 0.5f) * spacing;
    const float y = (static_cast<float>(j) + 0.5f) * spacing;
    if (!(surface > solid.bottom)) return bins.bodies[solid.highest_body].velocityAt({x, y, solid.top});
    // The velocity is linear along the ray: its mean over the interval is its value in the middle.
    return bins.bodies[solid.lowest_body].velocityAt(
        {x, y, 0.5f * (solid.bottom + minimum(solid.top, surface))});
  }
};

/// Depth of the sand inside of bodies, of one column. [m]
struct MeasureOverlap {
  BodyBins bins;
  SandColumns columns;
  const float* bed;
  const float* top;
  float* overlap;
  int across;
  float spacing;

  SHALLOW_SAND_HOST_DEVICE void operator()(int i, int j) const {
    const long long at = static_cast<long long>(j) * across + i;
    const float b = bed[at];
    const float ground = columns.ground(at).h;
    const float load = columns.load(at).h;
    const SolidIntervals solids = solidsAt(bins, i, j, spacing, b);
    float sum = 0.0f;
    float reached = b;
    for (int k = 0; k < solids.count; ++k) {
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
