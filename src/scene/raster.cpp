#include "raster.h"

#include <gdal_utils.h>

#include <algorithm>
#include <array>
#include <memory>

#include "gdal_support.h"

namespace shallow_sand {
namespace {

DatasetPointer memoryDataset(int width, int height, const std::string& path) {
  DatasetPointer dataset(gdalDriver("MEM", path).Create("", width, height, 1, GDT_Float32, nullptr));
  requireGdal(dataset != nullptr, path);
  return dataset;
}

DatasetPointer memoryDataset(const Raster& raster, const std::string& path) {
  DatasetPointer dataset = memoryDataset(raster.width, raster.height, path);
  float* values = const_cast<float*>(raster.values.data());
  requireGdal(
      dataset->GetRasterBand(1)->RasterIO(GF_Write, 0, 0, raster.width, raster.height, values, raster.width,
                                          raster.height, GDT_Float32, 0, 0, nullptr) == CE_None,
      path);
  return dataset;
}

Raster readBand(GDALDataset& dataset, int width, int height, GDALRIOResampleAlg method,
                const std::string& path) {
  Raster result{width, height, std::vector<float>(static_cast<std::size_t>(width) * height)};
  GDALRasterIOExtraArg how;
  INIT_RASTERIO_EXTRA_ARG(how);
  how.eResampleAlg = method;
  requireGdal(dataset.GetRasterBand(1)->RasterIO(GF_Read, 0, 0, dataset.GetRasterXSize(),
                                                 dataset.GetRasterYSize(), result.values.data(), width,
                                                 height, GDT_Float32, 0, 0, &how) == CE_None,
              path);
  return result;
}

}  // namespace

Raster resample(const Grid& grid, const std::vector<float>& values, int width, int height,
                GDALRIOResampleAlg method, const std::string& path) {
  const DatasetPointer dataset = memoryDataset(grid.columns, grid.rows, path);
  writeNorthUp(*dataset->GetRasterBand(1), values, grid, path);
  return readBand(*dataset, width, height, method, path);
}

Raster resample(const Raster& raster, int width, int height, GDALRIOResampleAlg method,
                const std::string& path) {
  return readBand(*memoryDataset(raster, path), width, height, method, path);
}

Raster hillshade(const Raster& elevation, double pixel, double exaggeration, const std::string& path) {
  const DatasetPointer surface = memoryDataset(elevation, path);
  std::array<double, 6> transform{0.0, pixel, 0.0, 0.0, 0.0, -pixel};
  surface->SetGeoTransform(transform.data());
  const std::string factor = std::to_string(exaggeration);
  std::array<const char*, 10> arguments{"-of", "MEM",  "-z", factor.c_str(),   "-az",
                                        "315", "-alt", "42", "-compute_edges", nullptr};
  const std::unique_ptr<GDALDEMProcessingOptions, decltype(&GDALDEMProcessingOptionsFree)> options(
      GDALDEMProcessingOptionsNew(const_cast<char**>(arguments.data()), nullptr),
      &GDALDEMProcessingOptionsFree);
  const DatasetPointer shade(GDALDataset::FromHandle(GDALDEMProcessing(
      "", GDALDataset::ToHandle(surface.get()), "hillshade", nullptr, options.get(), nullptr)));
  requireGdal(shade != nullptr, path);
  Raster result = readBand(*shade, elevation.width, elevation.height, GRIORA_NearestNeighbour, path);
  std::transform(result.values.begin(), result.values.end(), result.values.begin(),
                 [](float value) { return value / 255.0f; });
  return result;
}

}  // namespace shallow_sand
