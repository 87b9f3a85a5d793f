#pragma once

#include <OGRE/OgreRay.h>

#include <optional>

#include "shallow_sand/HeightField.h"

namespace shallow_sand {

/// How far along a ray, in the map's frame, it meets the ground's surface first [lengths of the ray's
/// direction]; nothing if it does not. The surface is linear between the centres of cells.
std::optional<float> meetSand(const HeightField& map, const Ogre::Ray& ray);

}  // namespace shallow_sand
