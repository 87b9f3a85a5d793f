#include "bounds.h"
#include "scene_reader.h"
#include "terrain.h"

namespace shallow_sand {
namespace {

/// Leaves `target` as it is where the key is absent or gives a file.
void readEven(const SceneValue& map, const std::string& key, const Bound& bound, double& target) {
  const auto value = map.find(key);
  if (value && !value->isMap()) {
    target = value->number(bound);
  }
}

/// Holds a cell's number to the bounds of Material.
void checkCell(const SceneValue& file, const Grid& grid, std::size_t cell, double in_file, double value,
               double Material::*member) {
  Material material;
  material.*member = value;
  try {
    material.validate();
  } catch (const InvalidParameter& error) {
    file.fail(file.path() + " " + givesText(in_file, grid, cell), error.expected());
  }
}

/// One value for each cell if the key gives a file, else nothing. @param unit of the file's numbers
std::vector<float> readField(const SceneValue& map, const std::string& key, const Grid& grid, double unit,
                             double Material::*member) {
  const auto value = map.find(key);
  if (!value || !value->isMap()) {
    return {};
  }
  std::vector<float> values = readTerrain(*value, grid);
  const SceneValue file = value->at("file");
  for (std::size_t cell = 0; cell < values.size(); ++cell) {
    const auto in_file = static_cast<double>(values[cell]);
    values[cell] = static_cast<float>(in_file * unit);
    checkCell(file, grid, cell, in_file, static_cast<double>(values[cell]), member);
  }
  return values;
}

}  // namespace

Material readMaterial(const SceneValue& material) {
  material.requireMap({"friction_angle", "dilute_layer"});
  Material parameters;
  if (const auto angle = material.find("friction_angle"); angle && !angle->isMap()) {
    parameters.friction_angle = radians(angle->number(bounds::finite));
  }
  if (const auto layer = material.find("dilute_layer")) {
    layer->requireMap({"fraction", "depth"});
    readEven(*layer, "fraction", bounds::finite, parameters.layer_fraction);
    readEven(*layer, "depth", bounds::finite_or_infinite, parameters.layer_depth);
  }
  return parameters;
}

MaterialFields readMaterialFields(const SceneValue& root, const Grid& grid) {
  MaterialFields fields;
  const auto material = root.find("material");
  if (!material) {
    return fields;
  }
  fields.friction_angle =
      readField(*material, "friction_angle", grid, radians(1.0), &Material::friction_angle);
  if (const auto layer = material->find("dilute_layer")) {
    fields.layer_fraction = readField(*layer, "fraction", grid, 1.0, &Material::layer_fraction);
    fields.layer_depth = readField(*layer, "depth", grid, 1.0, &Material::layer_depth);
  }
  return fields;
}

}  // namespace shallow_sand
