#pragma once

#include <string>

#include "shallow_sand/surface/surface_mesh.h"

namespace shallow_sand {

/// @param key by which the error names the path
/// @throws InvalidParameter if `path` ends in neither .stl nor .ply
void requireMeshSuffix(const std::string& key, const std::string& path);

/// Writes all triangles of the mesh, in the grid's frame [m], as binary STL, or as binary PLY (little-endian)
/// with normals and colours, as the path ends in .stl or .ply. The file appears when it is complete.
/// @throws InvalidParameter for another suffix
/// @throws std::runtime_error naming the file if it cannot be written
void writeMesh(const std::string& path, const SurfaceMesh& mesh);

}  // namespace shallow_sand
