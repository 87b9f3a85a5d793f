#pragma once

#include <cpl_error.h>
#include <gdal_priv.h>

#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <vector>

#include "shallow_sand/core/grid.h"

namespace shallow_sand {

/// GDAL prints its errors by itself; as long as this lives, on this thread, it only remembers them.
class QuietGdal {
 public:
  QuietGdal() {
    static std::once_flag registered;
    std::call_once(registered, [] { GDALAllRegister(); });
    CPLPushErrorHandler(CPLQuietErrorHandler);
    CPLErrorReset();
  }
  ~QuietGdal() { CPLPopErrorHandler(); }
  QuietGdal(const QuietGdal&) = delete;
  QuietGdal& operator=(const QuietGdal&) = delete;
};

/// For what GDAL reports by its return value. @throws std::runtime_error "PATH: MESSAGE"
inline void requireGdal(bool succeeded, const std::string& path) {
  if (!succeeded) {
    const std::string message = CPLGetLastErrorMsg();
    throw std::runtime_error(path + ": " + (message.empty() ? "GDAL could not write it" : message));
  }
}

/// Whether GDAL would look for a path elsewhere than in the file system: over the network, in archives, in
/// the output of programs. Its files in memory are ours.
inline bool leadsElsewhere(const std::string& path) {
  return path.rfind("/vsi", 0) == 0 && path.rfind("/vsimem/", 0) != 0;
}

struct CloseDataset {
  void operator()(GDALDataset* dataset) const { GDALClose(dataset); }
};
using DatasetPointer = std::unique_ptr<GDALDataset, CloseDataset>;

/// @throws std::runtime_error naming `path`
inline GDALDriver& gdalDriver(const char* name, const std::string& path) {
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName(name);
  if (driver == nullptr) {
    throw std::runtime_error(path + ": this GDAL has no driver " + name);
  }
  return *driver;
}

/// Writes a field of the grid to a whole band, or reads it. Memory holds the southernmost row first and
/// images the northernmost, so it is walked from its last row on, backwards.
/// @throws std::runtime_error naming `path`
inline void transferNorthUp(GDALRasterBand& band, GDALRWFlag direction, float* values, const Grid& grid,
                            const std::string& path) {
  const auto line = static_cast<GSpacing>(sizeof(float)) * grid.columns;
  requireGdal(band.RasterIO(direction, 0, 0, grid.columns, grid.rows, values + grid.index(0, grid.rows - 1),
                            grid.columns, grid.rows, GDT_Float32, sizeof(float), -line, nullptr) == CE_None,
              path);
}
inline void writeNorthUp(GDALRasterBand& band, const std::vector<float>& values, const Grid& grid,
                         const std::string& path) {
  // RasterIO takes a mutable buffer for both directions; writing only reads it.
  transferNorthUp(band, GF_Write, const_cast<float*>(values.data()), grid, path);
}

}  // namespace shallow_sand
