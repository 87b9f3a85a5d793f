#include "shallow_sand/scene/geotiff.h"

#include <array>
#include <cstdio>
#include <utility>

#include "gdal_support.h"

namespace shallow_sand {
namespace {

constexpr const char* kDomain = "SHALLOW_SAND";

std::string exact(double value) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%a", value);
  return text.data();
}

std::string edgeName(Edge edge) { return edge == Edge::open ? "open" : "wall"; }

void describeParameters(const SimulatorParameters& parameters, Metadata& metadata) {
  metadata["grid.size_x"] = exact(parameters.grid.size.x());
  metadata["grid.size_y"] = exact(parameters.grid.size.y());
  metadata["grid.spacing"] = exact(parameters.grid.spacing);
  metadata["grid.origin_x"] = exact(parameters.grid.origin.x());
  metadata["grid.origin_y"] = exact(parameters.grid.origin.y());
  metadata["grid.frame"] = parameters.grid.frame;
  metadata["gravity.x"] = exact(parameters.gravity.x());
  metadata["gravity.y"] = exact(parameters.gravity.y());
  metadata["gravity.z"] = exact(parameters.gravity.z());
  metadata["material.friction_angle_rad"] = exact(parameters.material.friction_angle);
  metadata["material.dilute_layer.fraction"] = exact(parameters.material.layer_fraction);
  metadata["material.dilute_layer.depth"] = exact(parameters.material.layer_depth);
  metadata["edges.x_min"] = edgeName(parameters.edges.x_min);
  metadata["edges.x_max"] = edgeName(parameters.edges.x_max);
  metadata["edges.y_min"] = edgeName(parameters.edges.y_min);
  metadata["edges.y_max"] = edgeName(parameters.edges.y_max);
  metadata["solver.reconstruction"] =
      parameters.solver.reconstruction == Reconstruction::minmod ? "minmod" : "constant";
  metadata["solver.courant"] = exact(parameters.solver.courant);
  metadata["solver.max_step"] = exact(parameters.solver.max_step);
  if (parameters.solver.fixed_step) {
    metadata["solver.fixed_step"] = exact(*parameters.solver.fixed_step);
  }
}

DatasetPointer createTiff(const std::string& path, const Grid& grid) {
  const std::array<const char*, 6> options{"COMPRESS=DEFLATE", "PREDICTOR=3", "INTERLEAVE=BAND",
                                           "BIGTIFF=IF_SAFER", "TILED=YES",   nullptr};
  DatasetPointer dataset(
      gdalDriver("GTiff", path)
          .Create(path.c_str(), grid.columns, grid.rows, 4, GDT_Float32, const_cast<char**>(options.data())));
  requireGdal(dataset != nullptr, path);
  const double spacing = static_cast<double>(grid.spacing);
  std::array<double, 6> transform{grid.origin_x, spacing, 0.0, grid.origin_y + grid.rows * spacing,
                                  0.0,           -spacing};
  requireGdal(dataset->SetGeoTransform(transform.data()) == CE_None, path);
  return dataset;
}

}  // namespace

Metadata stateMetadata(const Simulator& simulator) {
  const Ledger ledger = simulator.ledger();
  Metadata metadata{{"version", SHALLOW_SAND_VERSION},
                    {"time", exact(simulator.time())},
                    {"steps", std::to_string(simulator.progress().steps)},
                    {"cell_updates", std::to_string(simulator.progress().cell_updates)},
                    {"last_step", exact(simulator.progress().last_step)},
                    {"ledger.start", exact(ledger.start)},
                    {"ledger.poured", exact(ledger.poured)},
                    {"ledger.left", exact(ledger.left)},
                    {"ledger.now", exact(ledger.now)}};
  describeParameters(simulator.parameters(), metadata);
  return metadata;
}

void saveState(const std::string& path, const Grid& grid, const Fields& fields, const Metadata& metadata) {
  const std::array<std::pair<const char*, const std::vector<float>*>, 4> bands{
      {{"bed", &fields.bed},
       {"depth", &fields.depth},
       {"momentum_x", &fields.momentum_x},
       {"momentum_y", &fields.momentum_y}}};
  const QuietGdal quiet;
  for (const auto& band : bands) {
    if (band.second->size() != grid.cells()) {
      throw std::runtime_error(path + ": " + band.first + " does not hold one value for each cell");
    }
  }
  DatasetPointer dataset = createTiff(path, grid);
  for (std::size_t k = 0; k < bands.size(); ++k) {
    GDALRasterBand& band = *dataset->GetRasterBand(static_cast<int>(k) + 1);
    band.SetDescription(bands[k].first);
    writeNorthUp(band, *bands[k].second, grid, path);
  }
  for (const auto& item : metadata) {
    requireGdal(dataset->SetMetadataItem(item.first.c_str(), item.second.c_str(), kDomain) == CE_None, path);
  }
  dataset.reset();  // writes what is still in memory
  requireGdal(CPLGetLastErrorType() < CE_Failure, path);
}

}  // namespace shallow_sand
