#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "shallow_sand/core/fields.h"
#include "shallow_sand/core/grid.h"

namespace shallow_sand {

/// What a surface is made of.
enum class SurfaceMaterial : std::uint8_t { bed, sand };

/// How much light falls on a surface from the north-west, 1 if it is level. Viewers light a mesh from the
/// camera, which hides ruts; this shows them. @param normal of unit length, upward
inline float lightOn(const Eigen::Vector3f& normal) {
  // What is turned away from the sun still has light from the sky, the less the more.
  const float sun = normal.z() - 0.5f * normal.x() + 0.5f * normal.y();
  const float towards = 0.5f * (1.0f + sun);
  return 0.2f + 0.8f * towards * towards;
}

/// Red, green, blue from 0 to 1: sand in its own colour, bare bed grey, in that light.
inline Eigen::Vector3f surfaceColour(SurfaceMaterial material, const Eigen::Vector3f& normal) {
  const Eigen::Vector3f own = material == SurfaceMaterial::sand ? Eigen::Vector3f(0.93f, 0.78f, 0.54f)
                                                                : Eigen::Vector3f(0.60f, 0.59f, 0.57f);
  return (lightOn(normal) * own).cwiseMin(1.0f);
}

/// The colour of what one sees from above at the centre of each cell: the load where there is one, else the
/// ground.
std::vector<Eigen::Vector3f> visibleColours(const Grid& grid, const Fields& fields);
/// The light on it.
std::vector<float> visibleLight(const Grid& grid, const Fields& fields);

}  // namespace shallow_sand
