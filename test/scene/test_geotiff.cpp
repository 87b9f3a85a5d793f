#include <gdal_priv.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <limits>
#include <memory>

#include "random_seed.h"
#include "shallow_sand/scene/geotiff.h"
#include "shallow_sand/scene/scene.h"
#include "terrain_files.h"

namespace shallow_sand {
namespace {

ImagePointer open(const std::string& path) {
  GDALAllRegister();
  return ImagePointer(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY));
}

SimulatorParameters oddParameters() {
  SimulatorParameters parameters;
  parameters.grid.spacing = 0.02;
  parameters.grid.size = {37 * 0.02, 19 * 0.02};
  parameters.grid.origin = {-1.5, 4.25};
  parameters.backend = Backend::cpu;
  parameters.threads = 1;
  return parameters;
}

Snapshot stateOf(Fields fields) {
  Snapshot state;
  state.fields = std::move(fields);
  return state;
}

Fields randomFields(const Grid& grid) {
  std::mt19937 generator = seededGenerator();
  std::normal_distribution<float> value;
  const auto fill = [&] {
    std::vector<float> values(grid.cells());
    std::generate(values.begin(), values.end(), [&] { return value(generator); });
    // Bits that a conversion on the way would lose.
    values[0] = -0.0f;
    values[1] = std::numeric_limits<float>::denorm_min();
    return values;
  };
  return {fill(), fill(), fill(), fill()};
}

std::vector<float> readBand(GDALDataset& dataset, int band) {
  const int width = dataset.GetRasterXSize();
  const int height = dataset.GetRasterYSize();
  std::vector<float> values(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  EXPECT_EQ(dataset.GetRasterBand(band)->RasterIO(GF_Read, 0, 0, width, height, values.data(), width, height,
                                                  GDT_Float32, 0, 0, nullptr),
            CE_None);
  return values;
}

TEST(GeoTiff, KeepsEveryBitWithNorthOnTop) {
  const SimulatorParameters parameters = oddParameters();
  const Grid grid = parameters.grid.grid();
  const Fields fields = randomFields(grid);
  saveState("state.tif", parameters, stateOf(fields));
  const ImagePointer dataset = open("state.tif");
  ASSERT_NE(dataset, nullptr);
  ASSERT_EQ(dataset->GetRasterCount(), 4);
  const std::vector<std::pair<std::string, const std::vector<float>*>> bands{
      {"bed", &fields.bed},
      {"depth", &fields.depth},
      {"momentum_x", &fields.momentum_x},
      {"momentum_y", &fields.momentum_y}};
  for (int band = 1; band <= 4; ++band) {
    EXPECT_EQ(dataset->GetRasterBand(band)->GetDescription(), bands[band - 1].first);
    EXPECT_EQ(dataset->GetRasterBand(band)->GetRasterDataType(), GDT_Float32);
    const std::vector<float> values = readBand(*dataset, band);
    for (int j = 0; j < grid.rows; ++j) {
      const float* row = values.data() + grid.index(0, grid.rows - 1 - j);
      EXPECT_EQ(
          std::memcmp(row, bands[band - 1].second->data() + grid.index(0, j), grid.columns * sizeof(float)),
          0)
          << bands[band - 1].first << " row " << j;
    }
  }
}

TEST(GeoTiff, PlacesCellsWhereTheGridDoes) {
  const SimulatorParameters parameters = oddParameters();
  const Grid grid = parameters.grid.grid();
  saveState("placed.tif", parameters, stateOf(randomFields(grid)));
  const ImagePointer dataset = open("placed.tif");
  std::array<double, 6> transform{};
  ASSERT_EQ(dataset->GetGeoTransform(transform.data()), CE_None);
  const auto x = [&](int column) { return transform[0] + (column + 0.5) * transform[1]; };
  const auto y = [&](int line) { return transform[3] + (line + 0.5) * transform[5]; };
  EXPECT_NEAR(x(5), grid.x(5), 1e-12);
  EXPECT_NEAR(y(0), grid.y(grid.rows - 1), 1e-12);
  EXPECT_NEAR(y(grid.rows - 1), grid.y(0), 1e-12);
}

TEST(GeoTiff, MetadataBringsBackEveryBitOfASimulation) {
  SimulatorParameters parameters;
  parameters.grid.size = {0.4, 0.2};
  parameters.backend = Backend::cpu;
  parameters.threads = 1;
  const std::size_t cells = parameters.grid.grid().cells();
  std::vector<float> depth(cells, 0.1f);
  depth[cells / 2] = 0.3f;
  Simulator simulator(parameters, std::vector<float>(cells, 0.0f), depth);
  simulator.advance(0.1);
  saveState("simulated.tif", parameters, simulator.snapshot());

  const ImagePointer dataset = open("simulated.tif");
  const auto item = [&](const char* key) {
    const char* text = dataset->GetMetadataItem(key, "SHALLOW_SAND");
    EXPECT_NE(text, nullptr) << key;
    return text == nullptr ? std::numeric_limits<double>::quiet_NaN() : std::strtod(text, nullptr);
  };
  EXPECT_EQ(item("time"), simulator.time());
  EXPECT_EQ(item("ledger.start"), simulator.ledger().start);
  EXPECT_EQ(item("ledger.now"), simulator.ledger().now);
  EXPECT_EQ(item("grid.spacing"), parameters.grid.spacing);
  EXPECT_EQ(item("material.friction_angle_rad"), parameters.material.friction_angle);
  EXPECT_EQ(item("steps"), static_cast<double>(simulator.progress().steps));
  EXPECT_STREQ(dataset->GetMetadataItem("edges.x_min", "SHALLOW_SAND"), "wall");
  EXPECT_NE(dataset->GetMetadataItem("version", "SHALLOW_SAND"), nullptr);
}

TEST(GeoTiff, SaysWhichFileCannotBeWritten) {
  const SimulatorParameters parameters = oddParameters();
  const Grid grid = parameters.grid.grid();
  try {
    saveState("no_such_folder/state.tif", parameters, stateOf(randomFields(grid)));
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(std::string(error.what()).rfind("no_such_folder/state.tif: ", 0), 0u) << error.what();
  }
}

TEST(GeoTiff, RefusesFieldsOfAnotherSize) {
  const SimulatorParameters parameters = oddParameters();
  const Grid grid = parameters.grid.grid();
  Fields fields = randomFields(grid);
  fields.momentum_y.pop_back();
  EXPECT_THROW(saveState("short.tif", parameters, stateOf(fields)), std::runtime_error);
}

/// Why a state cannot be read.
std::string refusal(const std::string& path, const SimulatorParameters& parameters) {
  try {
    loadState(path, parameters);
  } catch (const SceneError& error) {
    return error.what();
  }
  return "";
}

TEST(GeoTiff, SaysWhyAStateCannotBeRead) {
  SimulatorParameters parameters = oddParameters();
  EXPECT_EQ(refusal("missing.tif", parameters).rfind("missing.tif: ", 0), 0u);
  std::ofstream("text.tif") << "no image";
  EXPECT_EQ(refusal("text.tif", parameters).rfind("text.tif: ", 0), 0u);
  saveState("odd.tif", parameters, stateOf(randomFields(parameters.grid.grid())));
  parameters.grid.origin.x() += 1.0;
  EXPECT_NE(refusal("odd.tif", parameters).find("odd.tif: grid.origin_x: -1.5"), std::string::npos)
      << refusal("odd.tif", parameters);
}

}  // namespace
}  // namespace shallow_sand
