#pragma once

#include <cmath>

#include "shallow_sand/core/types.h"

/// The shallow sand equations (Zhu et al., "Shallow Sand Equations"), discretised on square cells; one pure
/// function each, with the number of its equation. Only + − × / sqrt min max are used and nothing is fused,
/// so that every backend gives the same bits. SI units.
namespace shallow_sand {

/// What the equations need to know of the sand and its grid; computed once (see sandConstants).
struct SandConstants {
  float spacing;         ///< ΔL [m]
  float gravity;         ///< |g_z| [m/s²]
  float gravity_x;       ///< g_x [m/s²]
  float gravity_y;       ///< g_y [m/s²]
  float level_x;         ///< rise of a level surface from a cell to the next along x: ΔL g_x/|g_z| [m]
  float level_y;         ///< the same along y [m]
  float friction;        ///< μ = tan θ
  float repose_rise;     ///< μ ΔL: rise from a cell to the next that friction can hold [m]
  float layer_fraction;  ///< of layer(h)
  float layer_depth;     ///< h̄ of layer(h) [m]
  float epsilon;         ///< ε of Eq. 13 [m⁴]
};

/// Depth of the dilute layer where sand is h deep (Eq. 2, section 7.1): min(fraction·h, h̄). [m]
SHALLOW_SAND_HOST_DEVICE inline float diluteLayer(float h, const SandConstants& sand) {
  return minimum(sand.layer_fraction * h, sand.layer_depth);
}

/// Speed of waves on the dilute layer (Eq. 12, with the layer in place of the whole depth). [m/s]
SHALLOW_SAND_HOST_DEVICE inline float waveSpeed(float h, const SandConstants& sand) {
  return sqrtf(sand.gravity * diluteLayer(h, sand));
}

/// Factor that turns momentum into velocity (Eq. 13): 1/h for deep sand, falling to 0 where sand is much
/// thinner than a cell. ε is (0.1 ΔL)⁴: the paper's ΔL⁴ brakes every layer thinner than a cell. [1/m]
SHALLOW_SAND_HOST_DEVICE inline float inverseDepth(float h, const SandConstants& sand) {
  const float h4 = (h * h) * (h * h);
  return 1.41421356f * h / sqrtf(h4 + maximum(h4, sand.epsilon));
}

/// Part of a difference that friction does not hold: sign(d)·max(|d| − m, 0).
SHALLOW_SAND_HOST_DEVICE inline float shrink(float d, float m) {
  return maximum(d - m, 0.0f) + minimum(d + m, 0.0f);
}

/// One side of a face between two cells; `u` is the velocity across the face, `v` the one along it.
struct FaceSide {
  float h;
  float u;
  float v;
  float b;
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
/// only on the part of the surface's rise that friction cannot hold; and the flux of hu is hu², where the
/// paper prints hu²/2.
SHALLOW_SAND_HOST_DEVICE inline FaceFlux faceFlux(const FaceSide& left, const FaceSide& right,
                                                  float level_rise, const SandConstants& sand) {
  const float b_left = left.b + 0.5f * level_rise;
  const float b_right = right.b - 0.5f * level_rise;
  const float bed = maximum(b_left, b_right);
  const float h_left = maximum(0.0f, left.h + b_left - bed);
  const float h_right = maximum(0.0f, right.h + b_right - bed);
  const float c_left = waveSpeed(h_left, sand);
  const float c_right = waveSpeed(h_right, sand);
  const float a_plus = maximum(maximum(left.u + c_left, right.u + c_right), 0.0f);
  const float a_minus = minimum(minimum(left.u - c_left, right.u - c_right), 0.0f);
  // Both speeds are 0 only where nothing moves; then every numerator is 0 as well (the paper's δ).
  const float inverse_span = 1.0f / maximum(a_plus - a_minus, 1e-20f);
  const float diffusion = a_plus * a_minus;

  const float q_left = h_left * left.u;
  const float q_right = h_right * right.u;
  const float rise = shrink(h_right - h_left, sand.repose_rise);
  FaceFlux flux;
  flux.mass = ((a_plus * q_left - a_minus * q_right) + diffusion * rise) * inverse_span;
  flux.momentum_left =
      ((a_plus * (q_left * left.u) - a_minus * (q_right * right.u)) + diffusion * (q_right - q_left)) *
      inverse_span;
  flux.shear = ((a_plus * (q_left * left.v) - a_minus * (q_right * right.v)) +
                diffusion * (h_right * right.v - h_left * left.v)) *
               inverse_span;
  flux.momentum_right = flux.momentum_left;
  return flux;
}

/// What Eq. 11 and 12 give at a wall, where the other side is this one with its velocity across the face
/// reversed: no mass, no shear, and this momentum (the paper's words, without the reversed sign, leak).
/// `toward` is the velocity towards the wall. [m³/s²]
SHALLOW_SAND_HOST_DEVICE inline float wallMomentum(float h, float toward, const SandConstants& sand) {
  const float speed = fabsf(toward) + waveSpeed(h, sand);
  return (h * toward) * toward + speed * (h * toward);
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

/// Surface of a neighbour as the pressure sees it (Eq. 17): a dry neighbour whose bed stands above our
/// surface is level with us. [m]
SHALLOW_SAND_HOST_DEVICE inline float pressureSurface(float neighbour_h, float neighbour_b, float own_surface,
                                                      float level_rise) {
  const float surface = neighbour_h + neighbour_b;
  const float level = own_surface + level_rise;
  return neighbour_h <= 0.0f && surface > level ? level : surface;
}

struct Momentum {
  float x;
  float y;
};

/// Friction (Eq. 18, 19): takes as much of the momentum as it can within Δt, all of it if it can. It holds a
/// thousandth more than it brakes: on a slope at the very friction angle roundings would else keep sand
/// crawling for ever.
SHALLOW_SAND_HOST_DEVICE inline Momentum applyFriction(Momentum q, float layer, float dt,
                                                       const SandConstants& sand) {
  const float size = sqrtf(q.x * q.x + q.y * q.y);                // e₁
  const float reach = dt * sand.friction * sand.gravity * layer;  // e₂
  const float rest = size <= 1.001f * reach ? 0.0f : 1.0f - reach / maximum(size, 1e-30f);
  return {q.x * rest, q.y * rest};
}

}  // namespace shallow_sand
