#include "missing_thickness.h"

#include <algorithm>
#include <cmath>

namespace shallow_sand {
namespace {

constexpr double kPi = 3.14159265358979323846;
/// Rays start this share of the thickness asked for before or behind the surface.
constexpr double kOffset = 1e-4;
/// Tilted rays find the solid below an edge, where the one along the normal runs along a face. Five of them,
/// for one to lie between the faces of a right-angled corner.
constexpr int kTiltedRays = 5;
constexpr double kSlant = 1e-4;  ///< keeps rays off the edges that lie opposite to the point
constexpr double kTiltCosine = 0.8;
constexpr double kTiltSine = 0.6;

/// Certainly within the solid: behind a single sheet the number comes up to ½, and is known within an error.
bool isSolid(double winding) { return std::abs(winding) > 0.5 + kWindingError; }

/// How far into the solid the ray goes before it comes out again, at most `length`. [m]
/// @param winding the winding number where the ray starts
double solidAlong(const TriangleSurface& surface, const Eigen::Vector3d& from,
                  const Eigen::Vector3d& direction, double length, double winding) {
  double entered = 0.0;
  bool solid = isSolid(winding);
  const double slack = 2.0 * kOffset * length;
  for (const TriangleSurface::Crossing& crossing : surface.crossings(from, direction, length)) {
    winding += crossing.change;
    const bool solid_behind = isSolid(winding);
    if (solid && !solid_behind) return crossing.along - entered;
    if (!solid && solid_behind) {
      if (crossing.along > slack) return 0.0;
      entered = crossing.along;
    }
    solid = solid_behind;
  }
  return solid ? length - entered : 0.0;
}

/// The largest thickness found across the surface at `foot`, at most `least`. [m]
/// @param into of length 1, at right angles to the surface, into the solid
/// @param outside whether the winding number is that outside of the surface
double thickness(const TriangleSurface& surface, const Eigen::Vector3d& foot, const Eigen::Vector3d& into,
                 bool outside, double winding, double least) {
  const Eigen::Vector3d across = into.unitOrthogonal();
  const Eigen::Vector3d along = into.cross(across);
  const double offset = outside ? -kOffset * least : kOffset * least;
  double largest = 0.0;
  for (int ray = 0; ray <= kTiltedRays && largest < least; ++ray) {
    const double turn = 2.0 * kPi * (ray + 0.1) / kTiltedRays;
    const double cosine = ray == 0 ? 1.0 : kTiltCosine;
    const Eigen::Vector3d direction =
        ray == 0 ? Eigen::Vector3d((into + kSlant * (across + 0.3 * along)).normalized())
                 : kTiltCosine * into + kTiltSine * (std::cos(turn) * across + std::sin(turn) * along);
    const double length = (1.0 + 4.0 * kOffset) * least / cosine;
    const double inside = solidAlong(surface, foot + offset * direction, direction, length, winding);
    largest = std::max(largest, cosine * inside);
  }
  return std::min(largest, least);
}

}  // namespace

double missingThickness(const TriangleSurface& surface, const Eigen::Vector3d& point,
                        const TriangleSurface::Nearest& nearest, double winding, double least) {
  const Eigen::Vector3d foot = surface.footOn(nearest.triangle, point);
  const Eigen::Vector3d& normal = surface.normal(nearest.triangle);
  if (nearest.distance <= 2.0 * kOffset * least) {
    // On the surface nothing tells where the solid is: look on both sides.
    double largest = 0.0;
    for (const double side : {-1.0, 1.0}) {
      const Eigen::Vector3d into = side * normal;
      const double there = surface.windingNumber(foot - kOffset * least * into);
      largest = std::max(largest, thickness(surface, foot, into, true, there, least));
    }
    return least - largest;
  }
  const bool outside = std::abs(winding) <= 0.5;
  const Eigen::Vector3d into = normal.dot(outside ? foot - point : point - foot) >= 0.0 ? normal : -normal;
  // Off an open mesh the number is another than at its surface: behind a sheet it comes up to ½ only there.
  if (std::abs(winding - std::round(winding)) > kWindingError) {
    winding = surface.windingNumber(foot + (outside ? -kOffset : kOffset) * least * into);
  }
  return least - thickness(surface, foot, into, outside, winding, least);
}

}  // namespace shallow_sand
