#pragma once

#include <OGRE/OgreRay.h>

#include <optional>

#include "shallow_sand/HeightField.h"

namespace shallow_sand {

/// Of the ground's surface, bilinear between the centres of cells; beyond the outermost as at them. [m]
float elevationAt(const HeightField& map, float x, float y);

/// How far along a ray, in the map's frame, it meets the ground's surface first [lengths of the ray's
/// direction]; nothing if it does not.
std::optional<float> meetSand(const HeightField& map, const Ogre::Ray& ray);

}  // namespace shallow_sand
