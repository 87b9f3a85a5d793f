#pragma once

#include "shallow_sand/coupling/contact.h"
#include "shallow_sand/solver/step.h"

namespace shallow_sand {

/// Flow of loads on solids that do not touch the ground's sand: with each other, and with what a step sees
/// of the columns beside them, onto which they fall and from which sand runs onto them. Fluxes are those of
/// a step. Friction is with the solid, so that a bucket carries what is in it; where the gap below is lower
/// than a cell, it is with the sand around, which holds what lies over a body that moves through it.
struct FlowLoads {
  Step<true, false> step;  ///< the last one; its fields are those that it wrote
  SandColumns columns;
  ContactFields contact;
  const float* bed;
  std::uint8_t* flowed;  ///< whether anything might have, one a cell; is written
  SandLayer visible;     ///< are written there
  SandLayer hidden;

  SHALLOW_SAND_HOST_DEVICE bool onGrid(int i, int j) const {
    return i >= 0 && i < step.columns && j >= 0 && j < step.rows;
  }
  SHALLOW_SAND_HOST_DEVICE bool hangs(int i, int j) const {
    return onGrid(i, j) && columns.cover[step.index(i, j)] == Cover::hanging;
  }
  /// Whether there is a load that flows, or room for one beside sand that stands higher.
  SHALLOW_SAND_HOST_DEVICE bool mayFlow(int i, int j, float highest) const {
    if (!hangs(i, j)) return false;
    const long long at = step.index(i, j);
    // Fluxes measure from a level surface, and round: where one side of a face flows, the other must, too.
    const float margin = (fabsf(step.sand.level_x) + fabsf(step.sand.level_y)) + 0.01f * step.sand.spacing;
    return columns.hidden.depth[at] > 0.0f || highest + margin > contact.top[at];
  }
  /// Of the highest sand.
  SHALLOW_SAND_HOST_DEVICE float surface(int i, int j) const {
    if (!onGrid(i, j)) return -1e30f;
    const long long at = step.index(i, j);
    const float visible_surface = columns.visible_bed[at] + columns.visible.depth[at];
    const bool has_load = hangs(i, j) && columns.hidden.depth[at] > 0.0f;
    return has_load ? maximum(visible_surface, contact.top[at] + columns.hidden.depth[at]) : visible_surface;
  }
  /// Whether anything may flow to or from a hanging load here.
  SHALLOW_SAND_HOST_DEVICE bool isInvolved(int i, int j) const {
    if (!(hangs(i, j) || hangs(i - 1, j) || hangs(i + 1, j) || hangs(i, j - 1) || hangs(i, j + 1)))
      return false;
    const float around =
        maximum(maximum(surface(i - 1, j), surface(i + 1, j)), maximum(surface(i, j - 1), surface(i, j + 1)));
    const float own = surface(i, j);
    return mayFlow(i, j, around) || mayFlow(i - 1, j, own) || mayFlow(i + 1, j, own) ||
           mayFlow(i, j - 1, own) || mayFlow(i, j + 1, own);
  }

  SHALLOW_SAND_HOST_DEVICE void operator()(int i, int j) const {
    const long long at = step.index(i, j);
    flowed[at] = isInvolved(i, j) ? 1 : 0;
    if (flowed[at] == 0) return;
    const bool hanging = hangs(i, j);
    const Cell below = visibleCell(at);
    const Cell above = hanging ? loadCell(at) : below;
    Change to_below{};
    Change to_above{};
    meet<true>(i, j, i - 1, j, false, below, above, to_below, to_above);
    meet<true>(i, j, i + 1, j, true, below, above, to_below, to_above);
    meet<false>(i, j, i, j - 1, false, below, above, to_below, to_above);
    meet<false>(i, j, i, j + 1, true, below, above, to_below, to_above);
    visible.set(at, changed(columns.visible.get(at), to_below));
    hidden.set(at, hanging ? rubbed(at, above, to_above) : columns.hidden.get(at));
  }

 private:
  /// What a layer of a cell loses over its faces, times ΔL/Δt, and the rise of the surface across it.
  struct Change {
    float mass;
    float x;
    float y;
    float rise_x;
    float rise_y;
  };

  SHALLOW_SAND_HOST_DEVICE Cell visibleCell(long long at) const {
    const Sand sand = columns.visible.get(at);
    return cell(at, sand, columns.visible_bed[at], columns.ceiling[at]);
  }
  SHALLOW_SAND_HOST_DEVICE Cell loadCell(long long at) const {
    const Sand sand = columns.hidden.get(at);
    return cell(at, sand, contact.top[at], contact.headroom[at]);
  }
  SHALLOW_SAND_HOST_DEVICE Cell cell(long long at, const Sand& sand, float b, float room) const {
    Cell cell = step.cell(sand.h, sand.hu, sand.hv, b, room, step.materialAt(at));
    // Full is no wall here: sand may leave.
    cell.room = maximum(cell.room, 0.0f);
    return cell;
  }
  SHALLOW_SAND_HOST_DEVICE float underside(long long at) const { return bed[at] + contact.clearance[at]; }

  /// What both layers of cell (i, j) exchange with its neighbour (ni, nj).
  template <bool along_x>
  SHALLOW_SAND_HOST_DEVICE void meet(int i, int j, int ni, int nj, bool forward, const Cell& below,
                                     const Cell& above, Change& to_below, Change& to_above) const {
    if (!onGrid(ni, nj)) return wall<along_x>(forward, above, to_above);
    const long long at = step.index(i, j);
    const long long there = step.index(ni, nj);
    const bool hanging = hangs(i, j);
    const bool neighbour_hangs = hangs(ni, nj);
    const Cell their_below = visibleCell(there);
    if (neighbour_hangs) {
      const Cell their_above = loadCell(there);
      if (!hanging || their_above.s <= underside(at))
        exchange<along_x>(forward, below, their_above, to_below);
      if (!hanging) return;
      exchange<along_x>(forward, above, their_above, to_above);
      const bool falls_under = above.s <= underside(there);
      if (falls_under) exchange<along_x>(forward, above, their_below, to_above);
      lean<along_x>(forward, above, falls_under ? their_below : their_above, to_above);
    } else if (hanging) {
      exchange<along_x>(forward, above, their_below, to_above);
      lean<along_x>(forward, above, their_below, to_above);
    }
  }

  template <bool along_x>
  SHALLOW_SAND_HOST_DEVICE float levelRise(bool forward) const {
    const float rise = along_x ? step.sand.level_x : step.sand.level_y;
    return forward ? rise : -rise;
  }
  template <bool along_x>
  SHALLOW_SAND_HOST_DEVICE static FaceSide side(const Cell& cell) {
    return along_x ? Step<true, false>::centreX(cell) : Step<true, false>::centreY(cell);
  }

  template <bool along_x>
  SHALLOW_SAND_HOST_DEVICE void exchange(bool forward, const Cell& own, const Cell& other,
                                         Change& change) const {
    const Cell& left = forward ? own : other;
    const Cell& right = forward ? other : own;
    const FaceFlux flux =
        step.face<false>(side<along_x>(left), side<along_x>(right), left, right, levelRise<along_x>(true));
    const float sign = forward ? 1.0f : -1.0f;
    change.mass += sign * flux.mass;
    (along_x ? change.x : change.y) += sign * flux.momentum_left;
    (along_x ? change.y : change.x) += sign * flux.shear;
  }

  /// The neighbour's surface, as the pressure on a load sees it. Where it drops the load is pulled as on a
  /// slope of two to one: it falls, and what it leaves does not know how deep.
  template <bool along_x>
  SHALLOW_SAND_HOST_DEVICE void lean(bool forward, const Cell& own, const Cell& other, Change& change) const {
    const float level_rise = levelRise<along_x>(forward);
    const float level = own.s + level_rise;
    const float surface = maximum(step.surfaceOf(other, own, level_rise), level - 2.0f * step.sand.spacing);
    const float rise = forward ? surface : -surface;
    (along_x ? change.rise_x : change.rise_y) += rise;
  }
  template <bool along_x>
  SHALLOW_SAND_HOST_DEVICE void wall(bool forward, const Cell& own, Change& change) const {
    const float level = own.s + levelRise<along_x>(forward);
    (along_x ? change.rise_x : change.rise_y) += forward ? level : -level;
  }

  SHALLOW_SAND_HOST_DEVICE Sand changed(const Sand& sand, const Change& change) const {
    return {sand.h - step.per_length * change.mass, sand.hu - step.per_length * change.x,
            sand.hv - step.per_length * change.y};
  }

  /// Pressure and friction of a load (Eq. 17, 19).
  SHALLOW_SAND_HOST_DEVICE Sand rubbed(long long at, const Cell& own, const Change& change) const {
    const SandConstants& sand = step.sand;
    const float h = own.h - step.per_length * change.mass;
    const float inverse_spacing = 1.0f / sand.spacing;
    const float layer = diluteLayer(own.h, own.material);
    const float half = 0.5f * sand.gravity * inverse_spacing;
    const float push_x = layer * (sand.gravity_x - half * change.rise_x) - inverse_spacing * change.x;
    const float push_y = layer * (sand.gravity_y - half * change.rise_y) - inverse_spacing * change.y;
    const bool rides = contact.clearance[at] - columns.visible.depth[at] >= sand.spacing;
    const float base_x = rides ? h * contact.velocity_x[at] : 0.0f;
    const float base_y = rides ? h * contact.velocity_y[at] : 0.0f;
    const Momentum q{own.hu + step.dt * push_x - base_x, own.hv + step.dt * push_y - base_y};
    const Momentum rate{(own.hu - base_x) * step.per_time + push_x,
                        (own.hv - base_y) * step.per_time + push_y};
    const Momentum left = applyFriction(q, rate, layer, own.material.repose_rise, sand);
    if (!(h > sand.film)) return {h, 0.0f, 0.0f};
    return {h, left.x + base_x, left.y + base_y};
  }
};

/// 1 where a load may hang: FlowLoads does nothing but there, and beside it.
struct HangingCover {
  FlowLoads flow;

  SHALLOW_SAND_HOST_DEVICE float operator()(int i, int j) const { return flow.hangs(i, j) ? 1.0f : 0.0f; }
};

/// Above 0 where FlowLoads changed anything.
struct FlowedSand {
  FlowLoads flow;

  SHALLOW_SAND_HOST_DEVICE float operator()(int i, int j) const {
    const long long at = flow.step.index(i, j);
    if (flow.flowed[at] == 0) return 0.0f;
    return differ(flow.columns.visible.get(at), flow.visible.get(at)) ||
                   differ(flow.columns.hidden.get(at), flow.hidden.get(at))
               ? 1.0f
               : 0.0f;
  }

 private:
  SHALLOW_SAND_HOST_DEVICE static bool differ(const Sand& one, const Sand& other) {
    return one.h != other.h || one.hu != other.hu || one.hv != other.hv;
  }
};

/// Takes over what FlowLoads wrote.
struct CopyLoads {
  FlowLoads flow;

  SHALLOW_SAND_HOST_DEVICE void operator()(int i, int j) const {
    const long long at = flow.step.index(i, j);
    if (flow.flowed[at] == 0) return;
    flow.columns.visible.set(at, flow.visible.get(at));
    flow.columns.hidden.set(at, flow.hidden.get(at));
  }
};

}  // namespace shallow_sand
