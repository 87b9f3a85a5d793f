#pragma once

#include "shallow_sand/bodies/distance_field_view.h"

namespace shallow_sand {

/// A rigid body at one instant, as kernels see it. Positions are relative to the corner of cell (0, 0), so
/// that floats stay exact on maps far from their frame's origin. [m, m/s, rad/s]
struct BodyView {
  int number;  ///< of the body, among all that there ever were
  DistanceFieldView field;
  Vector3 axis_x;  ///< the grid's axes in the body's frame
  Vector3 axis_y;
  Vector3 axis_z;
  Vector3 position;  ///< of the body's origin
  Vector3 linear;    ///< V, velocity of the body's origin
  Vector3 angular;   ///< ω
  Vector3 low;       ///< box around the body
  Vector3 high;

  SHALLOW_SAND_HOST_DEVICE Vector3 toBody(Vector3 point) const {
    const float x = point.x - position.x;
    const float y = point.y - position.y;
    const float z = point.z - position.z;
    return {axis_x.x * x + axis_y.x * y + axis_z.x * z, axis_x.y * x + axis_y.y * y + axis_z.y * z,
            axis_x.z * x + axis_y.z * y + axis_z.z * z};
  }

  /// V + ω × r (Eq. 20).
  SHALLOW_SAND_HOST_DEVICE Vector3 velocityAt(Vector3 point) const {
    const float x = point.x - position.x;
    const float y = point.y - position.y;
    const float z = point.z - position.z;
    return {linear.x + (angular.y * z - angular.z * y), linear.y + (angular.z * x - angular.x * z),
            linear.z + (angular.x * y - angular.y * x)};
  }
};

}  // namespace shallow_sand
