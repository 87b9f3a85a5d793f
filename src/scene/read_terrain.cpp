#include "bounds.h"
#include "scene_reader.h"
#include "terrain.h"

namespace shallow_sand {

std::vector<float> readTerrain(const SceneValue& map, const Grid& grid,
                               const std::vector<std::string>& more_keys) {
  std::vector<std::string> keys{"file", "band", "origin", "size", "scale", "offset", "no_data"};
  keys.insert(keys.end(), more_keys.begin(), more_keys.end());
  map.requireMap(keys);
  TerrainParameters parameters;
  parameters.file = map.at("file").path();
  map.read("band", parameters.band);
  if (const auto origin = map.find("origin")) {
    parameters.origin = origin->vector<2>(bounds::finite);
  }
  if (const auto size = map.find("size")) {
    parameters.size = size->vector<2>(bounds::positive);
  }
  if (const auto scale = map.find("scale")) {
    parameters.scale = scale->number(bounds::finite);
  }
  if (const auto offset = map.find("offset")) {
    parameters.offset = offset->number(bounds::finite);
  }
  if (const auto no_data = map.find("no_data"); no_data && !no_data->is("error")) {
    parameters.no_data = no_data->number(bounds::error_or_finite);
  }
  std::vector<float> values;
  map.check([&] { values = readTerrain(parameters, grid); });
  return values;
}

}  // namespace shallow_sand
