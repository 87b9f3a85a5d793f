#pragma once

#include <cmath>

#include "scene_value.h"

namespace shallow_sand {

/// What the reader asks of numbers; where a parameter's own bounds are narrower, its validate() knows them. A
/// billion (metres, seconds, ...) keeps single precision from overflowing.
namespace bounds {

inline constexpr Bound finite{[](double v) { return std::abs(v) <= 1e9; },
                              "a finite number, at most 1e9 in size"};
inline constexpr Bound finite_or_infinite{[](double v) { return std::abs(v) <= 1e9 || std::isinf(v); },
                                          "a number, at most 1e9 in size, or .inf"};
inline constexpr Bound error_or_finite{[](double v) { return std::abs(v) <= 1e9; },
                                       "error, or a number, at most 1e9 in size"};
inline constexpr Bound positive{[](double v) { return v >= 1e-9 && v <= 1e9; }, "a number from 1e-9 to 1e9"};
inline constexpr Bound not_negative{[](double v) { return v >= 0.0 && v <= 1e9; }, "a number from 0 to 1e9"};
inline constexpr Bound slope_angle{[](double v) { return v > 0.0 && v < 90.0; },
                                   "an angle above 0 and below 90 degrees"};
inline constexpr Bound count{[](double v) { return v >= 1.0 && v <= 1e9 && v == std::floor(v); },
                             "a whole number from 1 on"};
inline constexpr Bound thread_count{[](double v) { return v >= 0.0 && v <= 4096.0 && v == std::floor(v); },
                                    "a whole number from 0 (as many as there are) to 4096"};

}  // namespace bounds

inline constexpr double kPi = 3.14159265358979323846;

/// Angles are degrees in files and radians in code.
inline double radians(double degrees) { return degrees * (kPi / 180.0); }

}  // namespace shallow_sand
