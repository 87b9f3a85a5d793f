#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>
#include <sys/socket.h>
#include <unistd.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <numeric>

#include "random_seed.h"
#include "shallow_sand/scene/geotiff.h"
#include "shallow_sand/scene/scene.h"
#include "shallow_sand/scene/simulation.h"
#include "shallow_sand/scene/terrain_heights.h"
#include "terrain_files.h"

namespace shallow_sand {
namespace {

/// The scene of a text whose files lie in the folder of the test.
Scene sceneFrom(const std::string& text) { return readScene(YAML::Load(text), "test.yaml", "."); }

std::string errorOf(const std::string& text) {
  try {
    sceneFrom(text);
  } catch (const SceneError& error) {
    return error.what();
  }
  ADD_FAILURE() << "accepted: " << text;
  return "";
}

void expectError(const std::string& text, const std::string& error) {
  EXPECT_EQ(errorOf(text), "test.yaml:1: " + error);
}

Grid gridOf(const Scene& scene) { return scene.parameters.grid.grid(); }

/// North up, by the corner with the smallest x and y.
std::array<double, 6> northUp(double x, double y, double pixel_x, double pixel_y, int lines) {
  return {x, pixel_x, 0.0, y + lines * pixel_y, 0.0, -pixel_y};
}

double sum(const std::vector<float>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

/// Pixels along one side of a grid of `cells` cells of 0.1 m, and more on both ends.
struct Side {
  double pixel = 0.0;
  double begin = 0.0;  ///< from the corner of the grid [m]
  int count = 0;
};

/// Longer than cells and lying anywhere, or whole fractions of cells.
Side randomSide(int cells, std::mt19937& generator) {
  std::uniform_real_distribution<double> number(0.0, 1.0);
  Side side;
  if (number(generator) < 0.5) {
    side.pixel = 0.1 * std::pow(10.0, number(generator));
    side.begin = -(1.0 + number(generator)) * side.pixel;
  } else {
    side.pixel = 0.1 / std::floor(2.0 + 8.0 * number(generator));
    side.begin = -0.1;
  }
  side.count = static_cast<int>((0.1 * cells + 0.1 - side.begin) / side.pixel) + 2;
  return side;
}

TEST(Terrain, APlaneStaysAPlaneWhereverTheImageLies) {
  std::mt19937 generator = seededGenerator();
  const auto number = [&generator](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(generator);
  };
  for (int k = 0; k < 40; ++k) {
    const Side side_x = randomSide(30, generator);
    const Side side_y = randomSide(20, generator);
    const Eigen::Vector2d origin(number(-1e6, 1e6), number(-1e6, 1e6));
    const Eigen::Vector2d slope(number(-1.0, 1.0), number(-1.0, 1.0));
    const auto plane = [&slope](double x, double y) { return 5.0 + slope.dot(Eigen::Vector2d(x, y)); };
    TestImage image;
    image.columns = side_x.count;
    image.lines = side_y.count;
    image.transform = northUp(origin.x() + side_x.begin, origin.y() + side_y.begin, side_x.pixel,
                              side_y.pixel, side_y.count);
    image.value = [&](int column, int line) {
      return plane(side_x.begin + (column + 0.5) * side_x.pixel,
                   side_y.begin + (side_y.count - line - 0.5) * side_y.pixel);
    };
    writeTiff("plane.tif", image);
    std::ostringstream text;
    text.precision(17);
    text << "{grid: {size: [3, 2], spacing: 0.1, origin: [" << origin.x() << ", " << origin.y()
         << "]}, bed: {file: plane.tif}}";
    const Scene scene = sceneFrom(text.str());
    const Grid grid = gridOf(scene);
    for (std::size_t cell = 0; cell < grid.cells(); ++cell) {
      const int i = static_cast<int>(cell) % grid.columns;
      const int j = static_cast<int>(cell) / grid.columns;
      ASSERT_NEAR(scene.bed[cell], plane(grid.x(i) - origin.x(), grid.y(j) - origin.y()), 2e-6)
          << "pixels " << side_x.pixel << " x " << side_y.pixel << " m, cell " << i << ", " << j;
    }
  }
}

/// What a scene reads, too, which names a number for the others.
TEST(Terrain, HeightsAreThoseOfCellsThatTheFileTellsOf) {
  std::mt19937 generator = seededGenerator();
  const auto number = [&generator](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(generator);
  };
  for (int k = 0; k < 20; ++k) {
    TestImage image;
    image.columns = 1 + static_cast<int>(generator() % 60);
    image.lines = 1 + static_cast<int>(generator() % 40);
    image.transform = northUp(number(-1.0, 2.0), number(-1.0, 1.0), 0.1, 0.1, image.lines);
    const double slope = number(-1.0, 1.0);
    image.value = [slope](int column, int line) { return slope * column + line; };
    writeTiff("part.tif", image);
    const Scene scene =
        sceneFrom("{grid: {size: [3, 2], spacing: 0.1}, bed: {file: part.tif, no_data: -7.5}}");
    const CellValues heights = readTerrainHeights("part.tif", gridOf(scene));
    for (std::size_t cell = 0; cell < scene.bed.size(); ++cell)
      ASSERT_EQ(heights.given[cell] != 0 ? heights.values[cell] : -7.5f, scene.bed[cell]);
  }
  EXPECT_THROW(readTerrainHeights("missing.tif", GridParameters().grid()), InvalidParameter);
}

TEST(Terrain, MeansKeepTheVolume) {
  std::mt19937 generator = seededGenerator();
  std::uniform_real_distribution<double> depth(0.0, 1.0);
  std::uniform_int_distribution<int> count(31, 200);
  for (int k = 0; k < 20; ++k) {
    TestImage image;
    image.columns = count(generator);
    image.lines = count(generator);
    image.transform = northUp(0.0, 0.0, 3.0 / image.columns, 2.0 / image.lines, image.lines);
    image.value = [&](int, int) { return depth(generator); };
    const ImagePointer memory = imageInMemory(image);
    writeImage("volume.tif", "GTiff", *memory);
    std::array<double, 2> range{};
    double mean = 0.0;
    double deviation = 0.0;
    memory->GetRasterBand(1)->ComputeStatistics(FALSE, &range[0], &range[1], &mean, &deviation, nullptr,
                                                nullptr);
    const Scene scene =
        sceneFrom("{grid: {size: [3, 2], spacing: 0.1}, sand: [{file: volume.tif, as: depth}]}");
    EXPECT_NEAR(sum(scene.depth) / static_cast<double>(scene.depth.size()), mean, 1e-6)
        << image.columns << " x " << image.lines << " pixels";
  }
}

TEST(Terrain, CellsOnPixelsGetTheirNumbersToTheBit) {
  std::mt19937 generator = seededGenerator();
  std::lognormal_distribution<float> value(-20.0f, 20.0f);
  SimulatorParameters parameters;
  parameters.grid.size = {1.23, 0.69};
  parameters.grid.spacing = 0.03;
  parameters.grid.origin = {-0.7, 5e5};
  const Grid grid = parameters.grid.grid();
  const auto field = [&] {
    std::vector<float> values(grid.cells());
    std::generate(values.begin(), values.end(), [&] { return std::min(value(generator), 1e9f); });
    values[7] = 0.0f;
    return values;
  };
  Snapshot state;
  state.fields = {field(), field(), field(), field()};
  const Fields& fields = state.fields;
  saveState("saved.tif", parameters, state);
  const std::string text =
      "{grid: {size: [1.23, 0.69], spacing: 0.03, origin: [-0.7, 500000]}, bed: {file: saved.tif, band: bed},"
      " sand: [{file: saved.tif, as: depth, band: ";
  for (const std::string band : {"depth", "2"}) {
    const Scene scene = sceneFrom(text + band + "}]}");
    EXPECT_EQ(std::memcmp(scene.bed.data(), fields.bed.data(), sizeof(float) * grid.cells()), 0);
    EXPECT_EQ(std::memcmp(scene.depth.data(), fields.depth.data(), sizeof(float) * grid.cells()), 0);
  }
}

TEST(Terrain, TheFirstLineIsNorth) {
  TestImage image;
  image.columns = 2;
  image.lines = 2;
  image.value = [](int column, int line) { return 10.0 * line + column; };
  writeTiff("corners.tif", image);
  const Scene scene = sceneFrom("{grid: {size: [2, 2], spacing: 1}, bed: {file: corners.tif}}");
  EXPECT_EQ(scene.bed, (std::vector<float>{10.0f, 11.0f, 0.0f, 1.0f}));
}

/// Hills of whole numbers, so that every format can hold them.
TestImage hills() {
  TestImage image;
  image.columns = 30;
  image.lines = 20;
  image.value = [](int column, int line) {
    return std::floor(30000.0 + 9000.0 * std::sin(0.3 * column) * line);
  };
  image.type = GDT_UInt16;
  return image;
}

TEST(Terrain, EveryFormatGivesTheSame) {
  const ImagePointer image = imageInMemory(hills());
  writeImage("hills.png", "PNG", *image);
  std::array<double, 6> transform = northUp(4e5, 5e6, 0.5, 0.5, 20);
  image->SetGeoTransform(transform.data());
  writeImage("hills.tif", "GTiff", *image);
  writeImage("hills.asc", "AAIGrid", *image);
  const std::string grid =
      "{grid: {size: [10, 10], spacing: 0.2, origin: [1, -2]}, bed: {scale: 0.001, offset: -30, ";
  const Scene png = sceneFrom(grid + "file: hills.png, origin: [0, -2], size: [15, 10]}}");
  const Scene tiff = sceneFrom(grid + "file: hills.tif, origin: [0, -2]}}");
  const Scene ascii = sceneFrom(grid + "file: hills.asc, origin: [0, -2]}}");
  EXPECT_EQ(tiff.bed, png.bed);
  EXPECT_EQ(ascii.bed, png.bed);
  EXPECT_GT(*std::max_element(png.bed.begin(), png.bed.end()), 10.0f);
}

TEST(Terrain, AnImageWithoutAPlaceSpansTheGrid) {
  TestImage image = hills();
  const std::string grid = "{grid: {size: [10, 5], spacing: 0.25, origin: [-3, 7]}, bed: {file: span.tif";
  writeTiff("span.tif", image);
  const Scene unplaced = sceneFrom(grid + "}}");
  image.transform = northUp(-3.0, 7.0, 10.0 / 30, 5.0 / 20, 20);
  writeTiff("span.tif", image);
  EXPECT_EQ(sceneFrom(grid + "}}").bed, unplaced.bed);
}

TEST(Terrain, ScaleAndOffsetOfTheFileHoldUnlessTheSceneGivesThem) {
  TestImage image;
  image.value = [](int, int) { return 100.0; };
  const ImagePointer memory = imageInMemory(image);
  memory->GetRasterBand(1)->SetScale(0.01);
  memory->GetRasterBand(1)->SetOffset(2.0);
  writeImage("scaled.tif", "GTiff", *memory);
  const std::string grid = "{grid: {size: [1, 1], spacing: 1}, bed: {file: scaled.tif";
  EXPECT_EQ(sceneFrom(grid + "}}").bed[0], 3.0f);
  EXPECT_EQ(sceneFrom(grid + ", scale: 1, offset: 0}}").bed[0], 100.0f);
  EXPECT_EQ(sceneFrom(grid + ", offset: -1}}").bed[0], 0.0f);
}

TEST(Terrain, SandFillsUpToASurfaceAndNoneIsTakenAway) {
  TestImage image;
  image.columns = 3;
  image.value = [](int column, int) { return 0.5 * column; };
  writeTiff("steps.tif", image);
  const Scene scene = sceneFrom(
      "{grid: {size: [3, 1], spacing: 1}, bed: {elevation: 0.25}, "
      "sand: [{depth: 0.5}, {file: steps.tif, as: surface}]}");
  EXPECT_EQ(scene.depth, (std::vector<float>{0.5f, 0.5f, 0.75f}));
}

/// One metre a pixel and a gap in the middle.
TestImage withGap(double gap) {
  TestImage image;
  image.columns = 3;
  image.lines = 3;
  image.value = [gap](int column, int line) { return column == 1 && line == 1 ? gap : 2.0; };
  image.transform = northUp(0.0, 0.0, 1.0, 1.0, 3);
  return image;
}

TEST(Terrain, GapsAreRefusedOrFilledAsTold) {
  const std::string grid = "{grid: {size: [3, 3], spacing: 1}, bed: {file: gap.tif";
  const std::string error =
      "bed.file: ./gap.tif has no data for 1 of 9 cells, the first of them at (1.5, 1.5); expected data for "
      "all cells, "
      "or no_data: the number for the others";
  TestImage marked = withGap(-9999.0);
  marked.no_data = -9999.0;
  for (const TestImage& image : {marked, withGap(std::nan("")), withGap(-INFINITY)}) {
    writeTiff("gap.tif", image);
    expectError(grid + "}}", error);
    expectError(grid + ", no_data: error}}", error);
    const Scene scene = sceneFrom(grid + ", no_data: -4}}");
    EXPECT_EQ(scene.bed, (std::vector<float>{2, 2, 2, 2, -4, 2, 2, 2, 2}));
  }
}

TEST(Terrain, TransparentPixelsHaveNoData) {
  GDALAllRegister();
  const ImagePointer image(
      GetGDALDriverManager()->GetDriverByName("MEM")->Create("", 2, 1, 2, GDT_UInt16, nullptr));
  image->GetRasterBand(1)->Fill(5.0);
  image->GetRasterBand(2)->SetColorInterpretation(GCI_AlphaBand);
  std::array<std::uint16_t, 2> alpha{65535, 0};
  ASSERT_EQ(
      image->GetRasterBand(2)->RasterIO(GF_Write, 0, 0, 2, 1, alpha.data(), 2, 1, GDT_UInt16, 0, 0, nullptr),
      CE_None);
  writeImage("transparent.png", "PNG", *image);
  const Scene scene =
      sceneFrom("{grid: {size: [2, 1], spacing: 1}, bed: {file: transparent.png, no_data: -1}}");
  EXPECT_EQ(scene.bed, (std::vector<float>{5.0f, -1.0f}));
}

TEST(Terrain, LessThanHalfOfACellIsNoData) {
  TestImage image;
  image.columns = 8;
  // Two, one and no pixels of the first three cells, all of the last.
  image.value = [](int column, int) {
    return column == 2 || column == 4 || column == 5 ? std::nan("") : 1.0 + column;
  };
  writeTiff("halves.tif", image);
  const Scene scene = sceneFrom("{grid: {size: [4, 1], spacing: 1}, bed: {file: halves.tif, no_data: 0}}");
  EXPECT_EQ(scene.bed, (std::vector<float>{1.5f, 4.0f, 0.0f, 7.5f}));
}

TEST(Terrain, CellsBesideTheImageHaveNoData) {
  writeTiff("small.tif", withGap(2.0));
  const std::string grid = "{grid: {size: [6, 5], spacing: 0.5, origin: [-1, 1]}, bed: {file: small.tif";
  EXPECT_NE(errorOf(grid + "}}").find("has no data for 96 of 120 cells, the first of them at (-0.75, 1.25)"),
            std::string::npos)
      << errorOf(grid + "}}");
  const Scene scene = sceneFrom(grid + ", no_data: 7}}");
  EXPECT_EQ(std::count(scene.bed.begin(), scene.bed.end(), 7.0f), 96);
  EXPECT_EQ(std::count(scene.bed.begin(), scene.bed.end(), 2.0f), 24);
  const Scene far = sceneFrom(grid + ", no_data: 7, origin: [1e8, -1e8]}}");
  EXPECT_EQ(std::count(far.bed.begin(), far.bed.end(), 7.0f), 120);
}

TEST(Terrain, GridsOfMillionsOfCellsHaveNoSeams) {
  TestImage image;
  image.columns = 24;
  image.lines = 24;
  image.value = [](int column, int line) { return column - 2.0 * line; };
  image.transform = northUp(-15.0, -15.0, 10.0, 10.0, 24);
  writeTiff("large.tif", image);
  const Scene scene = sceneFrom("{grid: {size: [210, 210], spacing: 0.1}, bed: {file: large.tif}}");
  const Grid grid = gridOf(scene);
  double worst = 0.0;
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      const double plane = 0.1 * (grid.x(i) + 10.0) - 2.0 * (23.0 - 0.1 * (grid.y(j) + 10.0));
      worst = std::max(worst, std::abs(static_cast<double>(scene.bed[grid.index(i, j)]) - plane));
    }
  }
  EXPECT_LT(worst, 1e-5);
}

TEST(Terrain, PathsStartFromTheFolderOfTheScene) {
  std::filesystem::create_directories("scenes/maps");
  TestImage image;
  image.value = [](int, int) { return 4.0; };
  writeTiff("scenes/maps/four.tif", image);
  const std::string text = "{grid: {size: [1, 1], spacing: 1}, bed: {file: maps/four.tif}}";
  std::ofstream("scenes/four.yaml") << text;
  EXPECT_EQ(loadScene("scenes/four.yaml").bed[0], 4.0f);
  const std::string absolute = std::filesystem::absolute("scenes/maps/four.tif").string();
  EXPECT_EQ(
      readScene(YAML::Load("{grid: {size: [1, 1], spacing: 1}, bed: {file: " + absolute + "}}"), "parameters")
          .bed[0],
      4.0f);
  try {
    readScene(YAML::Load(text), "parameters");
    FAIL();
  } catch (const SceneError& error) {
    EXPECT_EQ(
        std::string(error.what()),
        "parameters:1: bed.file: maps/four.tif; expected an absolute path, as this scene lies in no folder");
  }
}

TEST(Terrain, MapsOfTheMaterialAreHeldInTheUnitsOfTheCode) {
  TestImage image;
  image.columns = 2;
  image.value = [](int column, int) { return column == 0 ? 20.0 : 40.0; };
  writeTiff("angles.tif", image);
  const Scene scene = sceneFrom(
      "{grid: {size: [2, 1], spacing: 1}, material: {friction_angle: {file: angles.tif}, dilute_layer: "
      "{fraction: {file: angles.tif, scale: 0.02}, depth: 0.2}}}");
  EXPECT_EQ(scene.material_fields.friction_angle,
            (std::vector<float>{static_cast<float>(M_PI / 9.0), static_cast<float>(M_PI / 4.5)}));
  EXPECT_EQ(scene.material_fields.layer_fraction, (std::vector<float>{0.4f, 0.8f}));
  EXPECT_TRUE(scene.material_fields.layer_depth.empty());
  EXPECT_EQ(scene.parameters.material.layer_depth, 0.2);
  EXPECT_EQ(scene.parameters.material.friction_angle, Material().friction_angle);
}

TEST(Terrain, AMapOfTheMaterialRulesTheSand) {
  TestImage image;
  image.columns = 2;
  image.value = [](int column, int) { return column == 0 ? 10.0 : 40.0; };
  // Two halves of one angle each, but for the cells between their centres.
  writeTiff("halves.tif", image);
  const Scene scene = sceneFrom(
      "{grid: {size: [4, 1], spacing: 0.05}, material: {friction_angle: {file: halves.tif, origin: [-2, 0], "
      "size: [8, 1]}}, "
      "sand: [{cone: {center: [0.6, 0.5], height: 0.2, slope_angle: 30}}, {cone: {center: [3.4, 0.5], "
      "height: 0.2, slope_angle: 30}}], backend: cpu}");
  Simulator simulator = buildSimulator(scene);
  simulator.advance(0.5);
  const std::vector<float> depth = simulator.fields().depth;
  const Grid grid = gridOf(scene);
  double moved_low = 0.0;
  double moved_high = 0.0;
  for (std::size_t cell = 0; cell < grid.cells(); ++cell) {
    const double moved = std::abs(static_cast<double>(depth[cell]) - static_cast<double>(scene.depth[cell]));
    double& worst = cell % static_cast<std::size_t>(grid.columns) < 40 ? moved_low : moved_high;
    worst = std::max(worst, moved);
  }
  EXPECT_GT(moved_low, 0.02);
  EXPECT_EQ(moved_high, 0.0);
}

/// What stands in a scene after the grid, and its error.
struct TerrainMistake {
  std::string text;
  std::string error;
};

class TerrainMistakes : public ::testing::TestWithParam<TerrainMistake> {
 protected:
  static void SetUpTestSuite() {
    TestImage image;
    image.columns = 2;
    image.value = [](int column, int) { return column == 0 ? -0.5 : 95.0; };
    writeTiff("plain.tif", image);
    image.transform = std::array<double, 6>{0.0, 1.0, 0.5, 1.0, 0.0, -1.0};
    writeTiff("rotated.tif", image);
    image.transform = std::array<double, 6>{0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
    writeTiff("mirrored.tif", image);
    image.transform = northUp(0.0, 0.0, 1e-12, 1.0, 1);
    writeTiff("tiny.tif", image);
    image.transform = northUp(8.0, 48.0, 1.0, 1.0, 1);
    writeWithReference("degrees.tif", image, 4326);
    writeWithReference("feet.tif", image, 2225);
    image.transform = northUp(0.0, 0.0, 1.0, 1.0, 1);
    image.value = [](int, int) { return 1e12; };
    writeTiff("high.tif", image);
    image.type = GDT_CFloat32;
    writeTiff("complex.tif", image);
    std::ofstream("text.tif") << "no image at all";
    writeImage("other.img", "HFA", *imageInMemory(TestImage()));
    writeHuge("huge.tif", 200000, 200000, 8192);
    writeHuge("long.tif", 20000000, 1, 16);
    writeHuge("blocks.tif", 60000, 60000, 32768);
    writeHuge("bands.tif", 600, 600, 512, 3000);
  }

  static void writeWithReference(const std::string& path, const TestImage& image, int epsg) {
    const ImagePointer memory = imageInMemory(image);
    OGRSpatialReference reference;
    reference.importFromEPSG(epsg);
    memory->SetSpatialRef(&reference);
    writeImage(path, "GTiff", *memory);
  }

  /// Nothing but gaps, in few bytes. @param block length of the sides of its blocks
  static void writeHuge(const std::string& path, int columns, int lines, int block, int bands = 1) {
    const std::string width = "BLOCKXSIZE=" + std::to_string(block);
    const std::string height = "BLOCKYSIZE=" + std::to_string(block);
    std::array<const char*, 6> options{"SPARSE_OK=TRUE", "TILED=YES",    "INTERLEAVE=PIXEL",
                                       width.c_str(),    height.c_str(), nullptr};
    ImagePointer(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
        path.c_str(), columns, lines, bands, GDT_Int16, const_cast<char**>(options.data())));
  }
};

TEST_P(TerrainMistakes, AreOneClearLine) {
  expectError("{grid: {size: [2, 1], spacing: 1}, " + GetParam().text + "}", GetParam().error);
}

const std::string kFormats = "; expected a GeoTIFF, an ESRI ASCII grid or a PNG, in order";
const std::string kRemedy =
    "; expected coordinates in metres (gdalwarp -t_srs makes them), or origin and size";
const std::string kUpright = "; expected an image with north up, or origin and size";

TEST(Terrain, AFileThatEndsEarlyIsRefusedAtOnce) {
  std::ofstream("cut.asc") << "ncols 2\nnrows 100\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2\n3 4\n";
  const std::string error = errorOf("{grid: {size: [2, 1], spacing: 1}, bed: {file: cut.asc}}");
  EXPECT_EQ(error.rfind("test.yaml:1: bed.file: ./cut.asc cannot be read (", 0), 0u) << error;
  EXPECT_NE(error.find(kFormats), std::string::npos) << error;
}

TEST(Terrain, NothingIsFetched) {
  const int server = socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t length = sizeof(address);
  ASSERT_EQ(bind(server, reinterpret_cast<sockaddr*>(&address), length), 0);
  ASSERT_EQ(listen(server, 4), 0);
  ASSERT_EQ(getsockname(server, reinterpret_cast<sockaddr*>(&address), &length), 0);
  const std::string path =
      "/vsicurl/http://127.0.0.1:" + std::to_string(ntohs(address.sin_port)) + "/dem.tif";
  EXPECT_EQ(errorOf("{grid: {size: [2, 1], spacing: 1}, bed: {file: " + path + "}}"),
            "test.yaml:1: bed.file: " + path +
                " is no file; expected the path of a GeoTIFF, an ESRI ASCII grid or a PNG");
  EXPECT_EQ(accept(server, nullptr, nullptr), -1) << "somebody called";
  EXPECT_EQ(errno, EAGAIN);
  close(server);
}

INSTANTIATE_TEST_SUITE_P(
    Files, TerrainMistakes,
    ::testing::Values(
        TerrainMistake{
            "bed: {file: none.tif}",
            "bed.file: ./none.tif is no file; expected the path of a GeoTIFF, an ESRI ASCII grid or a PNG"},
        TerrainMistake{
            "bed: {file: .}",
            "bed.file: ./. is no file; expected the path of a GeoTIFF, an ESRI ASCII grid or a PNG"},
        TerrainMistake{"bed: {file: text.tif}", "bed.file: ./text.tif cannot be read" + kFormats},
        TerrainMistake{"bed: {file: other.img}", "bed.file: ./other.img cannot be read" + kFormats},
        TerrainMistake{"bed: {file: complex.tif}",
                       "bed.file: ./complex.tif holds complex numbers or colours of a palette; expected one "
                       "real number a pixel"},
        TerrainMistake{"bed: {file: rotated.tif}",
                       "bed.file: ./rotated.tif is rotated or mirrored" + kUpright},
        TerrainMistake{"bed: {file: mirrored.tif}",
                       "bed.file: ./mirrored.tif is rotated or mirrored" + kUpright},
        TerrainMistake{"bed: {file: tiny.tif}",
                       "bed.file: ./tiny.tif has a place or extent beyond all bounds; expected metres, from "
                       "1e-9 to 1e9, or origin and size"},
        TerrainMistake{"bed: {file: degrees.tif, origin: [0, 0]}",
                       "bed.file: ./degrees.tif lies in degrees of longitude and latitude" + kRemedy},
        TerrainMistake{"bed: {file: feet.tif}",
                       "bed.file: ./feet.tif has coordinates in other units than metres" + kRemedy},
        TerrainMistake{
            "bed: {file: high.tif}",
            "bed.file: ./high.tif gives 1e+12 at (0.5, 0.5); expected numbers of at most 1e9 in size"},
        TerrainMistake{"bed: {file: long.tif}",
                       "bed.file: ./long.tif is too fine; expected at most 2^24 pixels in a line on the "
                       "grid, and 2^32 in all"},
        TerrainMistake{"bed: {file: blocks.tif}",
                       "bed.file: ./blocks.tif is stored in too large blocks; expected at most 1 GiB each "
                       "(gdal_translate -co TILED=YES makes small ones)"},
        TerrainMistake{"bed: {file: bands.tif}",
                       "bed.file: ./bands.tif is stored in too large blocks; expected at most 1 GiB each "
                       "(gdal_translate -co TILED=YES makes small ones)"},
        TerrainMistake{"bed: {file: huge.tif}",
                       "bed.file: ./huge.tif is too fine; expected at most 2^24 pixels in a line on the "
                       "grid, and 2^32 in all"}));

INSTANTIATE_TEST_SUITE_P(
    Keys, TerrainMistakes,
    ::testing::Values(
        TerrainMistake{"bed: {file: plain.tif, band: 2}", "bed.band: 2; expected a number from 1 to 1"},
        TerrainMistake{
            "bed: {file: plain.tif, elevation: 2}",
            "bed.elevation: unknown key; expected one of: file, band, origin, size, scale, offset, no_data"},
        TerrainMistake{"bed: {file: plain.tif, no_data: ignore}",
                       "bed.no_data: ignore; expected error, or a number, at most 1e9 in size"},
        TerrainMistake{"bed: {file: plain.tif, size: [1, 0]}",
                       "bed.size[1]: 0; expected a number from 1e-9 to 1e9"},
        TerrainMistake{"bed: {file: [plain.tif]}", "bed.file: a list of 1; expected a text"},
        TerrainMistake{"sand: [{file: plain.tif}]", "sand[0].as: missing; expected this key"},
        TerrainMistake{"sand: [{file: plain.tif, as: sand}]", "sand[0].as: sand; expected surface or depth"},
        TerrainMistake{
            "sand: [{file: plain.tif, as: depth}]",
            "sand[0]: takes 0.5 m away at (0.5, 0.5); expected at most the 0 m of sand that lie there"},
        TerrainMistake{
            "material: {friction_angle: {file: plain.tif}}",
            "material.friction_angle.file: ./plain.tif gives -0.5 at (0.5, 0.5); expected an angle from 0 to "
            "less than 90 degrees"},
        TerrainMistake{
            "material: {friction_angle: {file: plain.tif, offset: 0.5}}",
            "material.friction_angle.file: ./plain.tif gives 95.5 at (1.5, 0.5); expected an angle from 0 to "
            "less than 90 degrees"},
        TerrainMistake{
            "material: {dilute_layer: {fraction: {file: plain.tif}}}",
            "material.dilute_layer.fraction.file: ./plain.tif gives -0.5 at (0.5, 0.5); expected a number "
            "above 0, at most 1"},
        TerrainMistake{
            "material: {dilute_layer: {depth: {file: plain.tif}}}",
            "material.dilute_layer.depth.file: ./plain.tif gives -0.5 at (0.5, 0.5); expected a positive "
            "number of metres, or .inf"}));

}  // namespace
}  // namespace shallow_sand
