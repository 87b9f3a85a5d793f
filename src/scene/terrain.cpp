#include "terrain.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <sstream>

#include "pixel_shares.h"
#include "shallow_sand/core/parameters.h"
#include "shallow_sand/scene/terrain_heights.h"
#include "terrain_file.h"

namespace shallow_sand {
namespace {

constexpr double kNoData = std::numeric_limits<double>::quiet_NaN();

/// Which pixels make up the cells.
struct Shares {
  std::vector<PixelShare> columns;
  std::vector<PixelShare> rows;
};

Shares sharesOf(const TerrainFile& file, const Grid& grid) {
  const int width = file.dataset->GetRasterXSize();
  const int height = file.dataset->GetRasterYSize();
  const double spacing = static_cast<double>(grid.spacing);
  const double left = (grid.origin_x - file.corner.x()) / file.pixel.x();
  // Lines of an image run from the north.
  const double low = height - (grid.origin_y - file.corner.y()) / file.pixel.y();
  return {pixelShares(grid.columns, left, spacing / file.pixel.x(), width),
          pixelShares(grid.rows, low, -spacing / file.pixel.y(), height)};
}

/// Pixels along one axis from the first to the last that cells need.
struct Window {
  int begin = std::numeric_limits<int>::max();
  int end = 0;
  int size() const { return std::max(0, end - begin); }
};

Window windowOf(const std::vector<PixelShare>& shares) {
  Window window;
  for (const PixelShare& share : shares) {
    if (share.count > 0) {
      window.begin = std::min(window.begin, share.first);
      window.end = std::max(window.end, share.first + share.count);
    }
  }
  return window;
}

/// Reads parts of lines of one band.
class LineReader {
 public:
  LineReader(const TerrainParameters& parameters, const TerrainFile& file)
      : parameters_(parameters), band_(*file.dataset->GetRasterBand(file.band)) {
    if ((band_.GetMaskFlags() & GMF_ALL_VALID) == 0) {
      mask_ = band_.GetMaskBand();
    }
  }

  /// NaN where there is no data.
  std::vector<double> read(int line, const Window& columns) {
    std::vector<double> values(static_cast<std::size_t>(columns.size()));
    transfer(band_, line, columns, values.data(), GDT_Float64);
    if (mask_ != nullptr) {
      std::vector<std::uint8_t> valid(values.size());
      transfer(*mask_, line, columns, valid.data(), GDT_Byte);
      std::transform(values.begin(), values.end(), valid.begin(), values.begin(),
                     [](double value, std::uint8_t is_valid) { return is_valid != 0 ? value : kNoData; });
    }
    return values;
  }

 private:
  void transfer(GDALRasterBand& band, int line, const Window& columns, void* target, GDALDataType type) {
    if (band.RasterIO(GF_Read, columns.begin, line, columns.size(), 1, target, columns.size(), 1, type, 0, 0,
                      nullptr) != CE_None) {
      failUnreadable(parameters_);
    }
  }

  const TerrainParameters& parameters_;
  GDALRasterBand& band_;
  GDALRasterBand* mask_ = nullptr;  ///< none: all pixels are valid
};

/// A weighted mean of the pixels that have data.
class Mean {
 public:
  void add(double weight, double value) {
    all_weights_ += weight;
    if (std::isfinite(value)) {
      weights_ += weight;
      sum_ += weight * value;
    }
  }
  /// NaN when less than half has data.
  double value() const {
    return weights_ > 0.0 && weights_ >= 0.5 * all_weights_ ? sum_ / weights_ : kNoData;
  }

 private:
  double all_weights_ = 0.0;
  double weights_ = 0.0;
  double sum_ = 0.0;
};

void addLine(const std::vector<double>& line, int line_begin, double line_weight,
             const std::vector<PixelShare>& shares, std::vector<Mean>& means) {
  for (std::size_t i = 0; i < shares.size(); ++i) {
    for (int k = 0; k < shares[i].count; ++k) {
      const auto pixel = static_cast<std::size_t>(shares[i].first - line_begin + k);
      means[i].add(line_weight * shares[i].weight(k), line[pixel]);
    }
  }
}

/// Keeps files from being read for hours, or in lines that no memory holds.
void requireFewPixels(const TerrainParameters& parameters, const Window& columns, const Window& lines) {
  constexpr int kMostAcross = 1 << 24;
  constexpr double kMostPixels = 4294967296.0;
  if (columns.size() > kMostAcross ||
      static_cast<double>(columns.size()) * static_cast<double>(lines.size()) > kMostPixels) {
    failTerrain(parameters, "is too fine", "at most 2^24 pixels in a line on the grid, and 2^32 in all");
  }
}

/// Goes through an ASCII grid up to where the reading starts. GDAL finds a line from the one before; when
/// that is missing, it tries anew from every line before, and from every line before each of these.
void approach(const TerrainFile& file, int line, LineReader& reader) {
  if (std::string(file.dataset->GetDriver()->GetDescription()) == "AAIGrid") {
    for (int before = 0; before < line; ++before) {
      reader.read(before, {0, 1});
    }
  }
}

/// "(X, Y)"
std::string centreText(const Grid& grid, std::size_t cell) {
  const auto columns = static_cast<std::size_t>(grid.columns);
  std::ostringstream text;
  text << "(" << grid.x(static_cast<int>(cell % columns)) << ", " << grid.y(static_cast<int>(cell / columns))
       << ")";
  return text.str();
}

/// A number of the file as a cell's; NaN where there is none.
float cellValue(const TerrainParameters& parameters, const Grid& grid, std::size_t cell, double value) {
  if (!std::isfinite(value)) {
    return std::numeric_limits<float>::quiet_NaN();
  }
  if (std::abs(value) > kLargestNumber) {
    failTerrain(parameters, givesText(value, grid, cell), "numbers of at most 1e9 in size");
  }
  return static_cast<float>(value);
}

/// NaN where the file has no data.
std::vector<float> readCells(const TerrainParameters& parameters, const Grid& grid) {
  const TerrainFile file = openTerrain(parameters, grid);
  GDALRasterBand& band = *file.dataset->GetRasterBand(file.band);
  const double scale = parameters.scale.value_or(band.GetScale());
  const double offset = parameters.offset.value_or(band.GetOffset());
  const Shares shares = sharesOf(file, grid);
  const Window columns = windowOf(shares.columns);
  const Window lines = windowOf(shares.rows);
  requireFewPixels(parameters, columns, lines);

  std::vector<float> result(grid.cells(), std::numeric_limits<float>::quiet_NaN());
  if (columns.size() == 0 || lines.size() == 0) {
    return result;
  }
  LineReader reader(parameters, file);
  approach(file, lines.begin, reader);
  for (int j = grid.rows - 1; j >= 0; --j) {
    const PixelShare& share = shares.rows[static_cast<std::size_t>(j)];
    std::vector<Mean> means(static_cast<std::size_t>(grid.columns));
    for (int k = 0; k < share.count; ++k) {
      addLine(reader.read(share.first + k, columns), columns.begin, share.weight(k), shares.columns, means);
    }
    for (int i = 0; i < grid.columns; ++i) {
      const std::size_t cell = grid.index(i, j);
      const double number = means[static_cast<std::size_t>(i)].value();
      result[cell] = cellValue(parameters, grid, cell, scale * number + offset);
    }
  }
  return result;
}

void fillGaps(const TerrainParameters& parameters, const Grid& grid, std::vector<float>& values) {
  const auto missing = [](float value) { return std::isnan(value); };
  const auto first = std::find_if(values.begin(), values.end(), missing);
  if (first == values.end()) {
    return;
  }
  if (!parameters.no_data) {
    failTerrain(parameters,
                "has no data for " + std::to_string(std::count_if(first, values.end(), missing)) + " of " +
                    std::to_string(values.size()) + " cells, the first of them at " +
                    centreText(grid, static_cast<std::size_t>(first - values.begin())),
                "data for all cells, or no_data: the number for the others");
  }
  std::replace_if(first, values.end(), missing, static_cast<float>(*parameters.no_data));
}

}  // namespace

std::string givesText(double value, const Grid& grid, std::size_t cell) {
  std::ostringstream text;
  text << "gives " << value << " at " << centreText(grid, cell);
  return text.str();
}

CellValues readTerrainHeights(const std::string& file, const Grid& grid) {
  TerrainParameters parameters;
  parameters.file = file;
  const QuietGdal quiet;
  CellValues heights{readCells(parameters, grid), std::vector<std::uint8_t>(grid.cells())};
  std::transform(heights.values.begin(), heights.values.end(), heights.given.begin(),
                 [](float value) { return static_cast<std::uint8_t>(std::isnan(value) ? 0 : 1); });
  return heights;
}

std::vector<float> readTerrain(const TerrainParameters& parameters, const Grid& grid) {
  const QuietGdal quiet;
  std::vector<float> values = readCells(parameters, grid);
  fillGaps(parameters, grid, values);
  return values;
}

}  // namespace shallow_sand
