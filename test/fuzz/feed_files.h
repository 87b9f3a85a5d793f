#pragma once

#include <cpl_vsi.h>
#include <gdal_priv.h>
#include <sys/mman.h>
#include <unistd.h>
#include <yaml-cpp/yaml.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "fuzz/outcome.h"
#include "fuzz/quick_grid.h"
#include "shallow_sand/scene/scene.h"

namespace shallow_sand {

/// Reads bytes as a scene file.
inline std::string feedScene(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    if (!isQuick(YAML::Load(text))) {
      return "";
    }
  } catch (const YAML::Exception&) {
  }
  const int file = memfd_create("scene", 0);
  if (file < 0 || write(file, data, size) != static_cast<ssize_t>(size)) {
    throw std::runtime_error("no file in memory");
  }
  const std::shared_ptr<void> closed(nullptr, [file](void*) { close(file); });
  return outcomeOf<SceneError>([file] { loadScene("/proc/self/fd/" + std::to_string(file)); });
}

/// A file in memory as long as this lives. The bytes must live longer.
class MemoryFile {
 public:
  MemoryFile(const char* path, const std::uint8_t* data, std::size_t size) : path_(path) {
    // GDAL takes a mutable buffer for files that are written, too.
    VSIFCloseL(VSIFileFromMemBuffer(path, const_cast<GByte*>(data), size, FALSE));
  }
  ~MemoryFile() { VSIUnlink(path_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

 private:
  const char* path_;
};

/// What GDAL makes of an image, in few numbers: its kind, how large it is, in which blocks it lies, ...
struct ImageTraits {
  double pixels = 0.0;  ///< of all bands
  double block_pixels = 0.0;
  std::vector<int> kinds;
};

inline ImageTraits traitsOf(const char* path) {
  static const bool registered = (GDALAllRegister(), true);
  static_cast<void>(registered);
  CPLPushErrorHandler(CPLQuietErrorHandler);
  const std::array<const char*, 4> formats{"GTiff", "AAIGrid", "PNG", nullptr};
  ImageTraits traits;
  if (GDALDatasetH image = GDALOpenEx(path, GDAL_OF_RASTER, formats.data(), nullptr, nullptr)) {
    GDALRasterBand& band = *GDALDataset::FromHandle(image)->GetRasterBand(1);
    int block_width = 0;
    int block_height = 0;
    band.GetBlockSize(&block_width, &block_height);
    traits.pixels = static_cast<double>(band.GetXSize()) * band.GetYSize() * GDALGetRasterCount(image);
    traits.block_pixels = static_cast<double>(block_width) * block_height;
    const auto magnitude = [](int number) { return number > 0 ? std::ilogb(number) : -1; };
    traits.kinds = {magnitude(GDALGetRasterCount(image)), band.GetRasterDataType(), band.GetMaskFlags(),
                    magnitude(block_width), magnitude(block_height)};
    GDALClose(image);
  }
  CPLPopErrorHandler();
  return traits;
}

/// Reads bytes as a terrain file: once where it says that it lies, once over the whole grid.
/// @return what came of it, and of GDAL's view on the file
inline std::vector<std::string> feedTerrain(const std::uint8_t* data, std::size_t size) {
  constexpr const char* kPath = "/vsimem/terrain";
  constexpr double kMostPixels = 1e6;
  const MemoryFile file(kPath, data, size);
  const ImageTraits traits = traitsOf(kPath);
  if (traits.pixels > kMostPixels || traits.block_pixels > kMostPixels) {
    return {};
  }
  YAML::Node scene = YAML::Load("{grid: {size: [3, 2], spacing: 0.25}, bed: {no_data: 0}}");
  scene["bed"]["file"] = kPath;
  std::vector<std::string> outcomes{outcomeOf<SceneError>([&scene] { readScene(scene, "scene"); })};
  scene["bed"]["origin"] = std::vector<double>{-0.1, -0.2};
  scene["bed"]["size"] = std::vector<double>{3.3, 2.5};
  outcomes.push_back(outcomeOf<SceneError>([&scene] { readScene(scene, "scene"); }));
  for (std::size_t k = 0; k < traits.kinds.size(); ++k) {
    outcomes.push_back("trait " + std::to_string(k) + " " + std::to_string(traits.kinds[k]));
  }
  return outcomes;
}

}  // namespace shallow_sand
