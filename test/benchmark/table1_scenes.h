#pragma once

#include "shallow_sand/scene/scene.h"

/// What stands in for the scenes of the paper's figures: sand and bodies for an empty map. Everything is
/// measured in cells, and moves for at least 1.4 s.
namespace shallow_sand {

void fillAvalanche(Scene& scene);   ///< snow that slides down a slope onto the plain
void fillButterfly(Scene& scene);   ///< a stick draws in a bed of sand
void fillFlattening(Scene& scene);  ///< a long block is pushed over it
void fillPile(Scene& scene);        ///< a low column of sand falls
void fillDamBreak(Scene& scene);    ///< half of the map, deep in sand, runs out onto the other
void fillThreeShapes(Scene& scene);
void fillCars(Scene& scene);        ///< two cars drive over a bed of sand
void fillWriting(Scene& scene);     ///< a pen, five cells thick, writes
void fillTallColumn(Scene& scene);  ///< a column higher than wide falls
void fillFan(Scene& scene);

}  // namespace shallow_sand
