#include "shallow_sand/scene/geotiff.h"

#include <array>
#include <utility>

#include "gdal_support.h"
#include "shallow_sand/core/replace_file.h"
#include "shallow_sand/scene/scene.h"
#include "state_metadata.h"

namespace shallow_sand {
namespace {

constexpr const char* kDomain = "SHALLOW_SAND";

/// The lists of a snapshot by the names of their bands. State: Snapshot, or const Snapshot.
template <class State>
auto fieldBands(State& state) {
  auto& f = state.fields;
  return std::array<std::pair<const char*, decltype(&f.bed)>, 4>{
      {{"bed", &f.bed}, {"depth", &f.depth}, {"momentum_x", &f.momentum_x}, {"momentum_y", &f.momentum_y}}};
}
/// Those that are there only where there are bodies.
template <class State>
auto loadBands(State& state) {
  auto& f = state.fields;
  return std::array<std::pair<const char*, decltype(&f.load)>, 4>{{{"load", &f.load},
                                                                   {"load_elevation", &f.load_elevation},
                                                                   {"load_momentum_x", &f.load_momentum_x},
                                                                   {"load_momentum_y", &f.load_momentum_y}}};
}
template <class State>
auto contactBands(State& state) {
  auto& c = state.contacts;
  return std::array<std::pair<const char*, decltype(&c.cover)>, 7>{{{"contact_clearance", &c.clearance},
                                                                    {"contact_headroom", &c.headroom},
                                                                    {"contact_cover", &c.cover},
                                                                    {"contact_length", &c.length},
                                                                    {"contact_velocity_x", &c.velocity_x},
                                                                    {"contact_velocity_y", &c.velocity_y},
                                                                    {"contact_velocity_z", &c.velocity_z}}};
}

/// @param part where it is written to become `path`, which errors name
DatasetPointer createTiff(const std::string& path, const std::filesystem::path& part, const Grid& grid,
                          int bands) {
  const std::array<const char*, 6> options{"COMPRESS=DEFLATE", "PREDICTOR=3", "INTERLEAVE=BAND",
                                           "BIGTIFF=IF_SAFER", "TILED=YES",   nullptr};
  DatasetPointer dataset(gdalDriver("GTiff", path)
                             .Create(part.c_str(), grid.columns, grid.rows, bands, GDT_Float32,
                                     const_cast<char**>(options.data())));
  requireGdal(dataset != nullptr, path);
  const double spacing = static_cast<double>(grid.spacing);
  std::array<double, 6> transform{grid.origin_x, spacing, 0.0, grid.origin_y + grid.rows * spacing,
                                  0.0,           -spacing};
  requireGdal(dataset->SetGeoTransform(transform.data()) == CE_None, path);
  return dataset;
}

void requireSizes(const std::string& path, const Grid& grid, const Snapshot& state) {
  for (const auto& band : fieldBands(state)) {
    if (band.second->size() != grid.cells())
      throw std::runtime_error(path + ": " + band.first + " does not hold one value for each cell");
  }
}

Metadata metadataOf(GDALDataset& dataset) {
  Metadata metadata;
  for (char** item = dataset.GetMetadata(kDomain); item != nullptr && *item != nullptr; ++item) {
    const std::string text = *item;
    const std::size_t equals = text.find('=');
    if (equals != std::string::npos) metadata[text.substr(0, equals)] = text.substr(equals + 1);
  }
  return metadata;
}

/// Null if there is none of that name.
GDALRasterBand* findBand(GDALDataset& dataset, const std::string& name) {
  for (int number = 1; number <= dataset.GetRasterCount(); ++number) {
    GDALRasterBand* band = dataset.GetRasterBand(number);
    if (band->GetDescription() == name) return band;
  }
  return nullptr;
}

GDALRasterBand& bandNamed(GDALDataset& dataset, const std::string& name) {
  if (GDALRasterBand* band = findBand(dataset, name)) return *band;
  throw InvalidParameter("band " + name, "missing", "a state that sand_run --save wrote");
}

Snapshot readState(GDALDataset& dataset, const SimulatorParameters& parameters, const std::string& path) {
  const Metadata metadata = metadataOf(dataset);
  requireSameGrid(metadata, parameters);
  const Grid grid = parameters.grid.grid();
  if (dataset.GetRasterXSize() != grid.columns || dataset.GetRasterYSize() != grid.rows)
    throw InvalidParameter("size", "not that of its metadata", "an image of the grid's size");
  Snapshot state = snapshotOf(metadata, grid);
  const auto read = [&](const auto& bands) {
    for (const auto& band : bands) {
      band.second->resize(grid.cells());
      transferNorthUp(bandNamed(dataset, band.first), GF_Read, band.second->data(), grid, path);
    }
  };
  read(fieldBands(state));
  if (findBand(dataset, "load") != nullptr) read(loadBands(state));
  if (!state.contacts.windows.empty()) read(contactBands(state));
  return state;
}

void writeState(const std::string& path, const std::filesystem::path& part,
                const SimulatorParameters& parameters, const Snapshot& state) {
  const Grid grid = parameters.grid.grid();
  const bool with_loads = !state.fields.load.empty();
  const bool with_contacts = !state.contacts.windows.empty();
  DatasetPointer dataset = createTiff(path, part, grid, 4 + (with_loads ? 4 : 0) + (with_contacts ? 7 : 0));
  int number = 0;
  const auto write = [&](const auto& bands) {
    for (const auto& band : bands) {
      dataset->GetRasterBand(++number)->SetDescription(band.first);
      writeNorthUp(*dataset->GetRasterBand(number), *band.second, grid, path);
    }
  };
  write(fieldBands(state));
  if (with_loads) write(loadBands(state));
  if (with_contacts) write(contactBands(state));
  for (const auto& item : stateMetadata(parameters, state)) {
    requireGdal(dataset->SetMetadataItem(item.first.c_str(), item.second.c_str(), kDomain) == CE_None, path);
  }
  dataset.reset();  // writes what is still in memory
  requireGdal(CPLGetLastErrorType() < CE_Failure, path);
}

}  // namespace

void saveState(const std::string& path, const SimulatorParameters& parameters, const Snapshot& state) {
  const QuietGdal quiet;
  requireSizes(path, parameters.grid.grid(), state);
  replaceFile(path, [&](const std::filesystem::path& part) { writeState(path, part, parameters, state); });
}

Snapshot loadState(const std::string& path, const SimulatorParameters& parameters) {
  const QuietGdal quiet;
  const std::array<const char*, 2> drivers{"GTiff", nullptr};
  if (leadsElsewhere(path))
    throw SceneError(path + ": is no file; expected a state that sand_run --save wrote");
  const DatasetPointer dataset(
      GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY, drivers.data()));
  if (dataset == nullptr)
    throw SceneError(path + ": " + CPLGetLastErrorMsg() + "; expected a state that sand_run --save wrote");
  try {
    return readState(*dataset, parameters, path);
  } catch (const InvalidParameter& problem) {
    throw SceneError(path + ": " + problem.what());
  } catch (const std::runtime_error& problem) {
    throw SceneError(problem.what());
  }
}

}  // namespace shallow_sand
