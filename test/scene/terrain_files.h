#pragma once

#include <gdal_priv.h>
#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace shallow_sand {

/// An image to write: pixel (column, line) from the top left, and where it lies.
struct TestImage {
  int columns = 1;
  int lines = 1;
  std::function<double(int column, int line)> value = [](int, int) { return 0.0; };
  std::optional<std::array<double, 6>> transform;  ///< GDAL's geotransform
  GDALDataType type = GDT_Float64;
  std::optional<double> no_data;
};

struct CloseImage {
  void operator()(GDALDataset* dataset) const { GDALClose(dataset); }
};
using ImagePointer = std::unique_ptr<GDALDataset, CloseImage>;

inline ImagePointer imageInMemory(const TestImage& image) {
  GDALAllRegister();
  ImagePointer dataset(GetGDALDriverManager()->GetDriverByName("MEM")->Create("", image.columns, image.lines,
                                                                              1, image.type, nullptr));
  std::vector<double> values;
  for (int line = 0; line < image.lines; ++line) {
    for (int column = 0; column < image.columns; ++column) {
      values.push_back(image.value(column, line));
    }
  }
  GDALRasterBand& band = *dataset->GetRasterBand(1);
  EXPECT_EQ(band.RasterIO(GF_Write, 0, 0, image.columns, image.lines, values.data(), image.columns,
                          image.lines, GDT_Float64, 0, 0, nullptr),
            CE_None);
  if (image.transform) {
    std::array<double, 6> transform = *image.transform;
    dataset->SetGeoTransform(transform.data());
  }
  if (image.no_data) {
    band.SetNoDataValue(*image.no_data);
  }
  return dataset;
}

/// @param driver by GDAL's name: GTiff, AAIGrid, PNG, ...
inline void writeImage(const std::string& path, const std::string& driver, GDALDataset& image) {
  EXPECT_NE(ImagePointer(GetGDALDriverManager()
                             ->GetDriverByName(driver.c_str())
                             ->CreateCopy(path.c_str(), &image, FALSE, nullptr, nullptr, nullptr)),
            nullptr)
      << path;
}

inline void writeTiff(const std::string& path, const TestImage& image) {
  writeImage(path, "GTiff", *imageInMemory(image));
}

}  // namespace shallow_sand
