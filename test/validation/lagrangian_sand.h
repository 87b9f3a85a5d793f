#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "profile.h"

namespace shallow_sand {

/// What the shallow sand equations need to know of a flow in one direction. SI units.
struct LagrangianLaw {
  double friction = 0.0;                                         ///< μ
  double gravity = 9.81;                                         ///< [m/s²]
  double slope = 0.0;                                            ///< fall of the bed along x
  double layer_fraction = 1.0;                                   ///< layer(h) = min(fraction·h, depth)
  double layer_depth = std::numeric_limits<double>::infinity();  ///< [m]
  bool around_axis = false;                                      ///< x is the distance from an axis
};

/// A second solver of the same equations, to compare with: in one dimension (a channel, or around an axis),
/// in double precision, and by another method. It follows the sand: columns that keep their volume between
/// nodes that carry the momentum, so that nothing is advected, fronts stay sharp and mass diffuses nowhere.
/// Converging sand is slowed by an artificial viscosity (von Neumann and Richtmyer 1950), as in codes for
/// gas. Friction is implicit and stops a node exactly.
class LagrangianSand {
 public:
  /// Sand that lies still, h(x) deep between the first and the last of `nodes` [m], and nothing elsewhere;
  /// walls hold the outermost nodes where told.
  template <class Depth>
  LagrangianSand(const LagrangianLaw& law, std::vector<double> nodes, const Depth& depth, bool wall_min,
                 bool wall_max)
      : law_(law), wall_min_(wall_min), wall_max_(wall_max), x_(std::move(nodes)), u_(x_.size(), 0.0) {
    for (std::size_t k = 0; k + 1 < x_.size(); ++k) {
      volume_.push_back(extent(k) * depth(0.5 * (x_[k] + x_[k + 1])));
    }
    depth_.resize(volume_.size());
    viscous_.resize(volume_.size());
    start_ = x_;
  }

  void advance(double duration) {
    const double end = time_ + duration;
    while (time_ < end) step(std::min(longestStep(), end - time_));
  }

  /// Goes on until nothing moves. @returns whether that was before `latest` [s]
  bool advanceToRest(double latest) {
    while (time_ < latest) {
      step(longestStep());
      if (maxSpeed() == 0.0) return true;
    }
    return false;
  }

  double time() const { return time_; }
  double maxSpeed() const {
    double speed = 0.0;
    for (const double u : u_) speed = std::max(speed, std::abs(u));
    return speed;
  }
  double front() const { return x_.back(); }  ///< where the sand ends [m]

  /// Up to where no sand moved by more than a millimetre. [m]
  double untouched() const {
    std::size_t i = 0;
    while (i + 1 < x_.size() && std::abs(x_[i] - start_[i]) < 1e-3) ++i;
    return start_[i];
  }

  Profile profile() const {
    Profile result;
    for (std::size_t k = 0; k < volume_.size(); ++k) {
      result.x.push_back(0.5 * (x_[k] + x_[k + 1]));
      result.depth.push_back(volume_[k] / extent(k));
    }
    if (!wall_max_) {
      result.x.push_back(x_.back());
      result.depth.push_back(0.0);
    }
    return result;
  }

 private:
  /// Area under column k, per metre of width or per radian. [m], [m²]
  double extent(std::size_t k) const {
    const double length = x_[k + 1] - x_[k];
    return law_.around_axis ? 0.5 * (x_[k + 1] + x_[k]) * length : length;
  }

  double longestStep() {
    double step = 1e-3;
    for (std::size_t k = 0; k < volume_.size(); ++k) {
      const double length = x_[k + 1] - x_[k];
      depth_[k] = volume_[k] / extent(k);
      const double wave = std::sqrt(law_.gravity * depth_[k]);
      const double closing = std::max(u_[k] - u_[k + 1], 0.0);
      // Viscosity of converging sand: pressure of a quadratic and of a small linear term. [m³/s²]
      viscous_[k] = depth_[k] * closing * (2.0 * closing + 0.2 * wave);
      step = std::min(step, 0.3 * length / (wave + 4.0 * closing + std::abs(u_[k + 1] - u_[k]) + 1e-9));
    }
    return step;
  }

  void step(double dt) {
    for (std::size_t i = 0; i < x_.size(); ++i) u_[i] = isHeld(i) ? 0.0 : velocityAfter(i, dt);
    for (std::size_t i = 0; i < x_.size(); ++i) x_[i] += dt * u_[i];
    time_ += dt;
  }

  bool isHeld(std::size_t i) const { return (i == 0 && wall_min_) || (i + 1 == x_.size() && wall_max_); }

  double velocityAfter(std::size_t i, double dt) const {
    const bool has_left = i > 0;
    const bool has_right = i < volume_.size();
    const double h_left = has_left ? depth_[i - 1] : 0.0;
    const double h_right = has_right ? depth_[i] : 0.0;
    const double mass = 0.5 * ((has_left ? volume_[i - 1] : 0.0) + (has_right ? volume_[i] : 0.0));
    const double width = law_.around_axis ? x_[i] : 1.0;
    const double h = has_left && has_right ? 0.5 * (h_left + h_right) : h_left + h_right;
    const double share = std::min(law_.layer_fraction * h, law_.layer_depth) / h;
    const double viscous = (has_left ? viscous_[i - 1] : 0.0) - (has_right ? viscous_[i] : 0.0);
    const double pressure = 0.5 * law_.gravity * (h_left * h_left - h_right * h_right);
    const double force =
        share * (pressure * width / mass + law_.gravity * law_.slope) + viscous * width / mass;
    const double u = u_[i] + dt * force;
    const double reach = dt * share * law_.friction * law_.gravity;
    return std::copysign(std::max(std::abs(u) - reach, 0.0), u);
  }

  LagrangianLaw law_;
  bool wall_min_;
  bool wall_max_;
  double time_ = 0.0;
  std::vector<double> x_;        ///< of the nodes [m]
  std::vector<double> u_;        ///< of the nodes [m/s]
  std::vector<double> start_;    ///< x_ at the start [m]
  std::vector<double> volume_;   ///< of the columns, per metre of width or per radian
  std::vector<double> depth_;    ///< of the columns [m]
  std::vector<double> viscous_;  ///< of the columns [m³/s²]
};

/// `count` + 1 nodes, evenly spaced.
inline std::vector<double> evenNodes(double begin, double end, int count) {
  std::vector<double> nodes;
  for (int i = 0; i <= count; ++i) nodes.push_back(begin + (end - begin) * i / count);
  return nodes;
}

/// `count` + 1 nodes, closer and closer together towards the end, where a front will thin the sand out.
inline std::vector<double> gradedNodes(double begin, double end, int count) {
  std::vector<double> nodes;
  for (int i = 0; i <= count; ++i) {
    nodes.push_back(end - (end - begin) * std::pow(1.0 - static_cast<double>(i) / count, 1.5));
  }
  return nodes;
}

}  // namespace shallow_sand
