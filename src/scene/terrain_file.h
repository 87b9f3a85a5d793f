#pragma once

#include "gdal_support.h"
#include "terrain.h"

namespace shallow_sand {

/// An image on the plane, north up.
struct TerrainFile {
  DatasetPointer dataset;
  int band = 1;            ///< number of the one to read
  Eigen::Vector2d corner;  ///< with the smallest x and y [m]
  Eigen::Vector2d pixel;   ///< extent of a pixel along x and y [m]
};

/// @throws InvalidParameter with the key `file` or `band`
TerrainFile openTerrain(const TerrainParameters& parameters, const Grid& grid);

/// Throws an InvalidParameter about the file: "file: PATH FOUND; expected EXPECTED".
[[noreturn]] void failTerrain(const TerrainParameters& parameters, const std::string& found,
                              const std::string& expected);

/// For what GDAL cannot read, with what it says about that.
[[noreturn]] void failUnreadable(const TerrainParameters& parameters);

}  // namespace shallow_sand
