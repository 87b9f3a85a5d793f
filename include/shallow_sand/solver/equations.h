#pragma once

#include <cmath>

#include "shallow_sand/core/types.h"

/// The shallow sand equations (Zhu et al., "Shallow Sand Equations"), discretised on square cells; one pure
/// function each, with the number of its equation. Only + − × / sqrt min max are used and nothing is fused,
/// so that every backend gives the same bits. SI units.
namespace shallow_sand {

/// The sand of one place.
struct LocalMaterial {
  float repose_rise;     ///< μ ΔL, μ = tan θ: rise from a cell to the next that friction can hold [m]
  float layer_fraction;  ///< of layer(h)
  float layer_depth;     ///< h̄ of layer(h) [m]
};

/// What the equations need to know of the sand and its grid; computed once (see sandConstants).
struct SandConstants {
  float spacing;              ///< ΔL [m]
  float gravity;              ///< |g_z| [m/s²]
  float gravity_per_spacing;  ///< |g_z|/ΔL [1/s²]
  float gravity_x;            ///< g_x [m/s²]
  float gravity_y;            ///< g_y [m/s²]
  float level_x;              ///< rise of a level surface from a cell to the next along x: ΔL g_x/|g_z| [m]
  float level_y;              ///< the same along y [m]
  float epsilon;              ///< ε of Eq. 13 [m⁴]
  float film;                 ///< sand no deeper than this sticks [m]
  LocalMaterial uniform;      ///< of every cell, unless the map says otherwise
};

/// Depth of the dilute layer where sand is h deep (Eq. 2, section 7.1): min(fraction·h, h̄). [m]
SHALLOW_SAND_HOST_DEVICE inline float diluteLayer(float h, const LocalMaterial& material) {
  return minimum(material.layer_fraction * h, material.layer_depth);
}

/// Speed of waves on a dilute layer (Eq. 12, with the layer in place of the whole depth). [m/s]
SHALLOW_SAND_HOST_DEVICE inline float waveSpeed(float layer, const SandConstants& sand) {
  return sqrtf(sand.gravity * layer);
}

/// Factor that turns momentum into velocity (Eq. 13): 1/h for deep sand, falling to 0 where sand is much
/// thinner than a cell, and 0 for a film. ε is (0.02 ΔL)⁴: the paper's ΔL⁴ brakes every layer thinner than a
/// cell. [1/m]
SHALLOW_SAND_HOST_DEVICE inline float inverseDepth(float h, const SandConstants& sand) {
  const float h4 = (h * h) * (h * h);
  const float inverse = 1.41421356f * h / sqrtf(h4 + maximum(h4, sand.epsilon));
  return h > sand.film ? inverse : 0.0f;
}

/// Part of a difference that friction does not hold: sign(d)·max(|d| − m, 0).
SHALLOW_SAND_HOST_DEVICE inline float shrink(float d, float m) { return d - maximum(minimum(d, m), -m); }

/// The smaller of two slopes of one sign, 0 between slopes of different signs.
SHALLOW_SAND_HOST_DEVICE inline float minmod(float a, float b) {
  return maximum(minimum(a, b), 0.0f) + minimum(maximum(a, b), 0.0f);
}

/// One side of a face between two cells; `u` is the velocity across the face, `v` the one along it.
struct FaceSide {
  float h;
  float u;
  float v;
  float b;
  float c;            ///< speed of waves [m/s]
  float repose_rise;  ///< μ ΔL [m]
};

/// What crosses a face per metre and second.
struct FaceFlux {
  float mass;            ///< h [m²/s]
  float momentum_left;   ///< momentum across the face as the cell at its left sees it [m³/s²]
  float momentum_right;  ///< as the cell at its right sees it; differs only where the face is a wall [m³/s²]
  float shear;           ///< momentum along the face [m³/s²]
};

/// Central-upwind flux (Eq. 11, 12) between the sand at the left and at the right of a face.
/// Depths are reconstructed above the higher bed (hydrostatic reconstruction), elevations measured from a
/// level surface, which in tilted gravity rises by `level_rise` from left to right; diffusion of mass acts
/// only on the part of the surface's rise that the rougher side's friction cannot hold; and the flux of hu is
/// hu², where the paper prints hu²/2.
SHALLOW_SAND_HOST_DEVICE inline FaceFlux faceFlux(const FaceSide& left, const FaceSide& right,
                                                  float level_rise) {
  const float step = (right.b - left.b) - level_rise;
  const float h_left = maximum(left.h - maximum(step, 0.0f), 0.0f);
  const float h_right = maximum(right.h + minimum(step, 0.0f), 0.0f);
  const float a_plus = maximum(maximum(left.u + left.c, right.u + right.c), 0.0f);
  const float a_minus = minimum(minimum(left.u - left.c, right.u - right.c), 0.0f);
  // Both speeds are 0 only where nothing moves; then every numerator is 0 as well (the paper's δ).
  const float inverse_span = 1.0f / maximum(a_plus - a_minus, 1e-20f);
  const float weight_left = a_plus * inverse_span;
  const float weight_right = a_minus * inverse_span;
  const float diffusion = (a_plus * a_minus) * inverse_span;

  const float rise = shrink(h_right - h_left, maximum(left.repose_rise, right.repose_rise));
  // Sand that each side sends, diffusion included; it carries that side's velocity.
  const float from_left = h_left * (weight_left * left.u - diffusion);
  const float from_right = h_right * (diffusion - weight_right * right.u);
  FaceFlux flux;
  flux.mass = (weight_left * (h_left * left.u) - weight_right * (h_right * right.u)) + diffusion * rise;
  flux.momentum_left = from_left * left.u + from_right * right.u;
  flux.shear = from_left * left.v + from_right * right.v;
  flux.momentum_right = flux.momentum_left;
  return flux;
}

/// What Eq. 11 and 12 give at a wall, where the other side is this one with its velocity across the face
/// reversed: no mass, no shear, and this momentum (the paper's words, without the reversed sign, leak).
/// `toward` is the velocity towards the wall. [m³/s²]
SHALLOW_SAND_HOST_DEVICE inline float wallMomentum(const FaceSide& side, float toward) {
  const float speed = fabsf(toward) + side.c;
  return (side.h * toward) * toward + speed * (side.h * toward);
}

/// Keeps a mass flux from draining a cell, or from filling the room under a body, in one step: a face may
/// take no more than a quarter of either. `rate` is ΔL/Δt. [m²/s]
SHALLOW_SAND_HOST_DEVICE inline float limitMassFlux(float mass, float holds_left, float holds_right,
                                                    float rate) {
  constexpr float kQuarter = 0.24999f;  // four faces together stay under the whole, whatever is rounded
  return minimum(maximum(mass, -(kQuarter * rate) * holds_right), (kQuarter * rate) * holds_left);
}

/// Whether a column is full up to the body above it; less room than a hundredth of a cell is none, so that
/// roundings of a moving body's underside open no gaps.
SHALLOW_SAND_HOST_DEVICE inline bool isFull(float h, float ceiling, float spacing) {
  return h + 0.01f * spacing >= ceiling;
}

struct Momentum {
  float x;
  float y;
};

/// Friction (Eq. 18, 19): what remains of a momentum `q` that would change at `rate` [m²/s²] in all within
/// Δt, on a dilute layer of depth `layer`. It takes as much as it can, all if it can. Whether sand is held is
/// decided on rates, so that for sand at rest the answer is the same for every Δt. Friction holds a
/// thousandth more than it brakes: on a slope at the very friction angle roundings would else keep sand
/// crawling for ever.
SHALLOW_SAND_HOST_DEVICE inline Momentum applyFriction(Momentum q, Momentum rate, float layer,
                                                       float repose_rise, const SandConstants& sand) {
  const float size = sqrtf(rate.x * rate.x + rate.y * rate.y);         // e₁/Δt
  const float reach = repose_rise * sand.gravity_per_spacing * layer;  // e₂/Δt
  const float rest = 1.0f - reach / maximum(size, 1e-30f);
  const bool held = size <= 1.001f * reach;
  // Adding 0 leaves no negative zeros, which would be bits that the next step changes.
  return {held ? 0.0f : q.x * rest + 0.0f, held ? 0.0f : q.y * rest + 0.0f};
}

}  // namespace shallow_sand
