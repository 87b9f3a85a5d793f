#include "terrain_file.h"

#include <cpl_vsi.h>
#include <ogr_spatialref.h>

#include <array>
#include <cmath>

#include "shallow_sand/core/parameters.h"

namespace shallow_sand {
namespace {

DatasetPointer openImage(const TerrainParameters& parameters) {
  VSIStatBufL status;
  if (leadsElsewhere(parameters.file) || VSIStatL(parameters.file.c_str(), &status) != 0 ||
      !VSI_ISREG(status.st_mode)) {
    failTerrain(parameters, "is no file", "the path of a GeoTIFF, an ESRI ASCII grid or a PNG");
  }
  // GDAL knows many more, some of which reach for other files or the network.
  const std::array<const char*, 4> formats{"GTiff", "AAIGrid", "PNG", nullptr};
  DatasetPointer dataset(GDALDataset::Open(parameters.file.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY,
                                           formats.data(), nullptr, nullptr));
  if (dataset == nullptr || dataset->GetRasterCount() == 0) {
    failUnreadable(parameters);
  }
  return dataset;
}

int findBand(GDALDataset& dataset, const TerrainParameters& parameters) {
  constexpr int kMostNames = 10;
  const int count = dataset.GetRasterCount();
  std::string names;
  for (int number = 1; number <= count; ++number) {
    const std::string description = dataset.GetRasterBand(number)->GetDescription();
    if (parameters.band.empty() || parameters.band == description ||
        parameters.band == std::to_string(number)) {
      return number;
    }
    const bool told = !description.empty() && number <= kMostNames;
    names += told ? ", " + description : "";
  }
  throw InvalidParameter("band", parameters.band, "a number from 1 to " + std::to_string(count) + names);
}

/// GDAL reads whole blocks, which may hold all bands. A file that names a huge one takes all memory, however
/// few bytes it has itself.
void requireSmallBlocks(const TerrainParameters& parameters, GDALDataset& dataset, GDALRasterBand& band) {
  constexpr double kMostBytes = 1073741824.0;
  int width = 0;
  int height = 0;
  band.GetBlockSize(&width, &height);
  const char* order = dataset.GetMetadataItem("INTERLEAVE", "IMAGE_STRUCTURE");
  const bool all_bands = order != nullptr && std::string(order) == "PIXEL";
  const double bytes = static_cast<double>(width) * height *
                       GDALGetDataTypeSizeBytes(band.GetRasterDataType()) *
                       (all_bands ? dataset.GetRasterCount() : 1);
  if (bytes > kMostBytes) {
    failTerrain(parameters, "is stored in too large blocks",
                "at most 1 GiB each (gdal_translate -co TILED=YES makes small ones)");
  }
}

void requireNumbers(const TerrainParameters& parameters, GDALRasterBand& band) {
  if (GDALDataTypeIsComplex(band.GetRasterDataType()) != 0 ||
      band.GetColorInterpretation() == GCI_PaletteIndex) {
    failTerrain(parameters, "holds complex numbers or colours of a palette", "one real number a pixel");
  }
}

/// The part of the plane that an image covers. [m]
struct Placement {
  Eigen::Vector2d corner;  ///< with the smallest x and y
  Eigen::Vector2d size;
};

void requireMetres(const TerrainParameters& parameters, const OGRSpatialReference& reference) {
  const std::string remedy = "coordinates in metres (gdalwarp -t_srs makes them), or origin and size";
  if (reference.IsGeographic() != 0) {
    failTerrain(parameters, "lies in degrees of longitude and latitude", remedy);
  }
  if (std::abs(reference.GetLinearUnits() - 1.0) > 1e-9) {
    failTerrain(parameters, "has coordinates in other units than metres", remedy);
  }
}

/// Where the file says that it lies; nothing when it does not say so.
std::optional<Placement> ownPlacement(const TerrainParameters& parameters, GDALDataset& dataset) {
  std::array<double, 6> transform{};
  if (dataset.GetGeoTransform(transform.data()) != CE_None) {
    return std::nullopt;
  }
  if (!(transform[1] > 0.0 && transform[5] < 0.0 && transform[2] == 0.0 && transform[4] == 0.0)) {
    failTerrain(parameters, "is rotated or mirrored", "an image with north up, or origin and size");
  }
  if (const OGRSpatialReference* reference = dataset.GetSpatialRef()) {
    requireMetres(parameters, *reference);
  }
  const Eigen::Vector2d size(transform[1] * dataset.GetRasterXSize(),
                             -transform[5] * dataset.GetRasterYSize());
  return Placement{{transform[0], transform[3] - size.y()}, size};
}

Placement placementOf(const TerrainParameters& parameters, GDALDataset& dataset, const Grid& grid) {
  if (parameters.origin && parameters.size) {
    return {*parameters.origin, *parameters.size};
  }
  const double spacing = static_cast<double>(grid.spacing);
  const Placement whole_grid{{grid.origin_x, grid.origin_y}, {grid.columns * spacing, grid.rows * spacing}};
  Placement placement = ownPlacement(parameters, dataset).value_or(whole_grid);
  placement.corner = parameters.origin.value_or(placement.corner);
  placement.size = parameters.size.value_or(placement.size);
  const auto within = [](const Eigen::Vector2d& v) { return (v.array().abs() <= kLargestNumber).all(); };
  if (!(within(placement.corner) && within(placement.size) && placement.size.minCoeff() >= 1e-9)) {
    failTerrain(parameters, "has a place or extent beyond all bounds",
                "metres, from 1e-9 to 1e9, or origin and size");
  }
  return placement;
}

}  // namespace

TerrainFile openTerrain(const TerrainParameters& parameters, const Grid& grid) {
  TerrainFile file;
  file.dataset = openImage(parameters);
  file.band = findBand(*file.dataset, parameters);
  GDALRasterBand& band = *file.dataset->GetRasterBand(file.band);
  requireNumbers(parameters, band);
  requireSmallBlocks(parameters, *file.dataset, band);
  const Placement placement = placementOf(parameters, *file.dataset, grid);
  file.corner = placement.corner;
  file.pixel = placement.size.cwiseQuotient(
      Eigen::Vector2d(file.dataset->GetRasterXSize(), file.dataset->GetRasterYSize()));
  return file;
}

void failTerrain(const TerrainParameters& parameters, const std::string& found, const std::string& expected) {
  throw InvalidParameter("file", parameters.file + " " + found, expected);
}

void failUnreadable(const TerrainParameters& parameters) {
  const std::string message = CPLGetLastErrorMsg();
  failTerrain(parameters, "cannot be read" + (message.empty() ? "" : " (" + message + ")"),
              "a GeoTIFF, an ESRI ASCII grid or a PNG, in order");
}

}  // namespace shallow_sand
