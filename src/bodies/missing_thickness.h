#pragma once

#include "triangle_surface.h"

namespace shallow_sand {

/// How much the solid lacks of `least` [m] in thickness where the surface is nearest to `point`; zero where
/// it is thick enough. [m]
/// @param nearest what `surface` says of `point`
/// @param winding the winding number at `point`
double missingThickness(const TriangleSurface& surface, const Eigen::Vector3d& point,
                        const TriangleSurface::Nearest& nearest, double winding, double least);

}  // namespace shallow_sand
