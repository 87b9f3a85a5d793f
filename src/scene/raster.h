#pragma once

#include <gdal_priv.h>

#include <string>
#include <vector>

#include "shallow_sand/core/grid.h"

namespace shallow_sand {

/// One number for each pixel of an image, row by row from the top.
struct Raster {
  int width = 0;
  int height = 0;
  std::vector<float> values;
};

/// A field of the grid as an image of this size, north up. @throws std::runtime_error naming `path`
Raster resample(const Grid& grid, const std::vector<float>& values, int width, int height,
                GDALRIOResampleAlg method, const std::string& path);
Raster resample(const Raster& raster, int width, int height, GDALRIOResampleAlg method,
                const std::string& path);

/// How bright a surface is under a sun in the north-west and a sky that is brighter there: 0 dark to 1
/// bright.
/// @param elevation [m]
/// @param pixel edge length of a pixel [m]
/// @param exaggeration factor on the elevation
/// @throws std::runtime_error naming `path`
Raster hillshade(const Raster& elevation, double pixel, double exaggeration, const std::string& path);

}  // namespace shallow_sand
