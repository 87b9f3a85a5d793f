#pragma once

#include <cmath>

#include "shallow_sand/coupling/contact.h"
#include "shallow_sand/particles/grain.h"

namespace shallow_sand {

/// The sand that one sees from above, as Fields::hasLoad has it: grains belong to that.
struct VisibleSand {
  Step<false, false> step;  ///< of which Δt is not used; the ground of a map without bodies is in its fields
  SandColumns columns;      ///< of one with bodies
  bool with_bodies;

  SHALLOW_SAND_HOST_DEVICE Sand get(long long at) const {
    if (!with_bodies) return {step.in.depth[at], step.in.momentum_x[at], step.in.momentum_y[at]};
    const Sand load = columns.load(at);
    return load.h >= Fields::kDust ? load : columns.ground(at);
  }
  /// Depth of its dilute layer. [m]
  SHALLOW_SAND_HOST_DEVICE float layer(long long at) const {
    return diluteLayer(get(at).h, step.materialAt(at));
  }
  /// The velocity of its grains, see GrainSpeed. [m/s]
  SHALLOW_SAND_HOST_DEVICE Momentum velocity(long long at, GrainSpeed speed) const {
    const Sand sand = get(at);
    float per_momentum = inverseDepth(sand.h, step.sand);
    // Where Eq. 13 has no velocity the layer may be nothing.
    if (speed == GrainSpeed::dilute && per_momentum > 0.0f)
      per_momentum = per_momentum * (sand.h / diluteLayer(sand.h, step.materialAt(at)));
    return {per_momentum * sand.hu, per_momentum * sand.hv};
  }
};

/// Where a grain is, or comes to.
struct GrainPlace {
  int s;    ///< column of J
  int t;    ///< row
  float x;  ///< offset, 0 ≤ x < 1 [Δl]
  float y;
  bool left;  ///< over an open edge
};

/// How grains move in a time Δt. Velocities are 0 where nothing moves, so that grains there keep their bits.
struct GrainFlow {
  GrainGrid grains;
  VisibleSand sand;
  const float* u;  ///< velocity of the grains of each cell of I [m/s]
  const float* v;
  GrainSpeed speed;
  float cells_per_speed;  ///< Δt/Δl [s/m]
  float cells_of_sand;    ///< Δl/ΔL

  /// No grain goes farther in a move, along either axis; nobody who looks more than a few times a second sees
  /// one that would. [cells of I]
  static constexpr int kLongestWay = 32;

  /// The four cells of I around a place, and how much each counts (Eq. 28, 29). Beyond the edge of the grid
  /// goes on what is at it.
  struct Weights {
    long long south_west;
    long long south_east;
    long long north_west;
    long long north_east;
    float east;
    float north;

    /// F_I of Eq. 27.
    SHALLOW_SAND_HOST_DEVICE float mean(float at_south_west, float at_south_east, float at_north_west,
                                        float at_north_east) const {
      const float at_south = (1.0f - east) * at_south_west + east * at_south_east;
      const float at_north = (1.0f - east) * at_north_west + east * at_north_east;
      return (1.0f - north) * at_south + north * at_north;
    }
    template <class Field>
    SHALLOW_SAND_HOST_DEVICE float operator()(const Field& field) const {
      return mean(field(south_west), field(south_east), field(north_west), field(north_east));
    }
  };

  SHALLOW_SAND_HOST_DEVICE Weights weightsAt(int s, int t, float x, float y) const {
    const Between i = between(s, x, sand.step.columns);
    const Between j = between(t, y, sand.step.rows);
    const long long south = sand.step.index(0, j.below);
    const long long north = sand.step.index(0, j.above);
    return {south + i.below, south + i.above, north + i.below, north + i.above, i.share, j.share};
  }

  /// By how many cells of J a grain moves (Eq. 31).
  SHALLOW_SAND_HOST_DEVICE Momentum wayOf(const Grain& grain, int s, int t, int d) const {
    const Weights weights = weightsAt(s, t, grain.x, grain.y);
    const Momentum velocity = velocityAt(weights);
    if (velocity.x == 0.0f && velocity.y == 0.0f) return {0.0f, 0.0f};
    if (speed == GrainSpeed::dilute) {
      // The paper would let all grains go as fast. Then more than hu would flow.
      const float layer = weights([this](long long at) { return sand.layer(at); });
      if (depthOf(grain, d, grains.spacing) > layer) return {0.0f, 0.0f};
    }
    return way(velocity);
  }

  /// Where a grain of a cell comes to (Eq. 31, 32): walls stop it.
  SHALLOW_SAND_HOST_DEVICE GrainPlace placeOf(const Grain& grain, int s, int t, int d) const {
    const Momentum moved = wayOf(grain, s, t, d);
    GrainPlace place{s, t, grain.x + moved.x, grain.y + moved.y, false};
    const OpenEdges& open = sand.step.open;
    const bool left_x = settle(place.s, place.x, grains.columns, open.x_min, open.x_max);
    const bool left_y = settle(place.t, place.y, grains.rows, open.y_min, open.y_max);
    place.left = left_x || left_y;
    return place;
  }

  /// The cell of a layer from which sand has come to a place in cell (s, t).
  SHALLOW_SAND_HOST_DEVICE long long upstreamOf(const Grain& grain, int s, int t, int d) const {
    const Momentum moved = way(velocityAt(weightsAt(s, t, grain.x, grain.y)));
    float x = grain.x - moved.x;
    float y = grain.y - moved.y;
    settle(s, x, grains.columns, false, false);
    settle(t, y, grains.rows, false, false);
    return grains.index(s, t, d);
  }

 private:
  struct Between {
    int below;
    int above;
    float share;  ///< of the one above
  };
  SHALLOW_SAND_HOST_DEVICE Between between(int cell, float offset, int count) const {
    const int own = grains.cellOfSand(cell);
    const float along = (static_cast<float>(cell - own * grains.per_cell) + offset) * cells_of_sand - 0.5f;
    const int before = along < 0.0f ? 1 : 0;
    const int below = own - before;
    return {below < 0 ? 0 : below, below + 1 < count ? below + 1 : count - 1,
            along + static_cast<float>(before)};
  }

  SHALLOW_SAND_HOST_DEVICE Momentum velocityAt(const Weights& weights) const {
    return {weights([this](long long at) { return u[at]; }), weights([this](long long at) { return v[at]; })};
  }
  SHALLOW_SAND_HOST_DEVICE Momentum way(const Momentum& velocity) const {
    const float longest = static_cast<float>(kLongestWay * grains.per_cell);
    return {minimum(maximum(cells_per_speed * velocity.x, -longest), longest),
            minimum(maximum(cells_per_speed * velocity.y, -longest), longest)};
  }

  /// Makes of an offset from a cell a cell and an offset in it (Eq. 32). Returns whether it left over an open
  /// edge.
  SHALLOW_SAND_HOST_DEVICE static bool settle(int& cell, float& offset, int count, bool open_below,
                                              bool open_above) {
    const int towards_zero = static_cast<int>(offset);
    const int whole = towards_zero - (offset < static_cast<float>(towards_zero) ? 1 : 0);
    // A tiny step back would round to 1.
    offset = minimum(offset - static_cast<float>(whole), kBelowOne);
    cell += whole;
    if (cell < 0) {
      cell = 0;
      offset = 0.0f;
      return open_below;
    }
    if (cell >= count) {
      cell = count - 1;
      offset = kBelowOne;
      return open_above;
    }
    return false;
  }
};

}  // namespace shallow_sand
