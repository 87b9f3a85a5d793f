#pragma once

#include <cstdint>

#include "shallow_sand/solver/cover.h"
#include "shallow_sand/solver/step.h"

namespace shallow_sand {

/// Sand of a column: its depth and its momentum.
struct Sand {
  float h = 0.0f;   ///< [m]
  float hu = 0.0f;  ///< [m²/s]
  float hv = 0.0f;  ///< [m²/s]
};

SHALLOW_SAND_HOST_DEVICE inline Sand sumOf(const Sand& one, const Sand& other) {
  return {one.h + other.h, one.hu + other.hu, one.hv + other.hv};
}

/// One value a cell of each, on the memory of a backend.
struct SandLayer : SandFieldsOut {
  SHALLOW_SAND_HOST_DEVICE Sand get(long long at) const {
    return {depth[at], momentum_x[at], momentum_y[at]};
  }
  SHALLOW_SAND_HOST_DEVICE void set(long long at, const Sand& sand) const {
    depth[at] = sand.h;
    // Adding 0 leaves no negative zeros, which would be bits that a step changes.
    momentum_x[at] = sand.hu + 0.0f;
    momentum_y[at] = sand.hv + 0.0f;
  }
};

/// What the rays found, one value a cell. The lowest solid of a column is what bodies fill of it from their
/// lowest point up; gaps lower than a cell count as filled.
struct ContactFields {
  float* clearance;   ///< depth of sand that fits under the lowest solid, infinite without one [m]
  float* top;         ///< elevation of its upper side [m]
  float* headroom;    ///< depth of sand that fits on it, under the next solid; infinite without one [m]
  float* length;      ///< of it within the ground's sand, Ω_s of Eq. 20 [m]
  float* velocity_x;  ///< V + ω × r of the body in the middle of that length, or at its top if there is none
                      ///< [m/s]
  float* velocity_y;
  float* velocity_z;
  int* body;            ///< the number of that body; negative where there is none, or it is not known
  std::uint8_t* swept;  ///< whether something that it does not climb has come into the sand on the solid

  SHALLOW_SAND_HOST_DEVICE bool isCovered(long long at) const { return clearance[at] < 1e30f; }
};

/// w̃ of Eq. 20, of a column of depth h in which a body takes up `length`. [m/s]
SHALLOW_SAND_HOST_DEVICE inline float meanVerticalVelocity(float length, float velocity_z, float h) {
  // In thin sand the length is mostly rounding.
  return length > 0.0f && h > 0.0f ? minimum(length / h, 1.0f) * velocity_z : 0.0f;
}

/// Momentum of sand beside a body that moves up or down (Eq. 24), where w̃ differs by `difference` [m/s] from
/// one neighbour to the other. The paper adds ΔL/2·Δw̃ in every step, so that it grows with their number;
/// here it is what the momentum is brought to. Sand thinner than half a cell is pushed no faster than the
/// body moves. [m²/s]
SHALLOW_SAND_HOST_DEVICE inline float pushedAside(float momentum, float h, float difference, float spacing) {
  const float target = minimum(0.5f * spacing, h) * difference;
  if (target > 0.0f) return maximum(momentum, target);
  return target < 0.0f ? minimum(momentum, target) : momentum;
}

/// Columns with two layers of sand: the ground's, on the bed, and a load on the lowest solid. Where ground
/// and solid touch, the column is closed: its surface is the load's, and a step sees the solid as ground with
/// the load on it, while the sand below keeps still. Elsewhere a step sees the ground, and loads flow by
/// FlowLoads.
struct SandColumns {
  SandLayer visible;   ///< what a step sees
  SandLayer hidden;    ///< the other layer
  float* visible_bed;  ///< what the visible layer lies on [m]
  float* ceiling;      ///< depth of visible sand for which there is room, infinite without a body above [m]
  Cover* cover;        ///< where a body touches the ground's sand, the visible layer is the load

  SHALLOW_SAND_HOST_DEVICE Sand ground(long long at) const {
    return cover[at] == Cover::touching ? hidden.get(at) : visible.get(at);
  }
  SHALLOW_SAND_HOST_DEVICE Sand load(long long at) const {
    return cover[at] == Cover::touching ? visible.get(at) : hidden.get(at);
  }
};

/// Above 0 where sand reaches above an elevation, or more than dust lies on a body.
struct SandAbove {
  SandColumns columns;
  float elevation;  ///< [m]
  float dust;       ///< depth [m]
  int across;       ///< cells in a row

  SHALLOW_SAND_HOST_DEVICE float operator()(int i, int j) const {
    const long long at = static_cast<long long>(j) * across + i;
    const bool lies = columns.load(at).h > dust;
    return lies || columns.visible_bed[at] + columns.visible.depth[at] > elevation ? 1.0f : 0.0f;
  }
};

}  // namespace shallow_sand
