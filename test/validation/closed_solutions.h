#pragma once

#include <cmath>

namespace shallow_sand {

/// A dam breaks on a plane: sand lies `depth` deep where x < 0. Where the plane falls more steeply than
/// friction holds: Mangeney, Heinrich and Roche 2000, Pure and Applied Geophysics 157, 1081; in the
/// horizontal plane: Mungkasi and Roberts 2011, ANZIAM J. 52, C349. Without slope and friction: Ritter 1892.
/// Dilute layer = whole depth. SI units.
struct DamBreakSolution {
  double slope;     ///< fall of the bed along x
  double friction;  ///< μ ≤ slope
  double depth;
  double gravity = 9.81;

  double depthAt(double x, double time) const {
    const double c = std::sqrt(gravity * depth);
    const double xi = x - 0.5 * gravity * (slope - friction) * time * time;
    if (xi < -c * time) return depth;
    if (xi > 2.0 * c * time) return 0.0;
    return std::pow(2.0 * c - xi / time, 2) / (9.0 * gravity);
  }
};

/// A parabolic cap slides down a plane and spreads, all of it moving (Savage and Hutter 1989, J. Fluid Mech.
/// 199, 177; here with an earth pressure of 1 and in the horizontal plane): h = h₀ L₀/L (1 − ((x − x_c)/L)²).
/// Holds where 2 h₀/L₀ < slope − μ. SI units.
struct ParabolicCap {
  double slope = std::tan(35.0 * M_PI / 180.0);
  double friction = std::tan(23.0 * M_PI / 180.0);
  double depth = 0.05;       ///< h₀
  double half_length = 0.5;  ///< L₀
  double gravity = 9.81;

  double centre(double time) const { return 0.5 * gravity * (slope - friction) * time * time; }

  /// L: the root y = L/L₀ of t √(4 g h₀)/L₀ = √(y(y − 1)) + ln(√y + √(y − 1)), which rises with y.
  double halfLength(double time) const {
    const double t = time * std::sqrt(4.0 * gravity * depth) / half_length;
    double low = 1.0;
    double high = 1.0 + t * t + t;
    for (int k = 0; k < 100; ++k) {
      const double y = 0.5 * (low + high);
      const double reached = std::sqrt(y * (y - 1.0)) + std::log(std::sqrt(y) + std::sqrt(y - 1.0));
      (reached < t ? low : high) = y;
    }
    return low * half_length;
  }

  double depthAt(double x, double time) const {
    const double length = halfLength(time);
    const double s = (x - centre(time)) / length;
    return std::abs(s) < 1.0 ? depth * half_length / length * (1.0 - s * s) : 0.0;
  }
};

}  // namespace shallow_sand
