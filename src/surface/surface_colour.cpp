#include "shallow_sand/surface/surface_colour.h"

#include "relief.h"

namespace shallow_sand {

namespace {

/// What function(material, normal) makes of each cell, as one sees it from above.
template <class Value, class Function>
std::vector<Value> visibleValues(const Grid& grid, const Fields& fields, const Function& function) {
  const Lattice lattice = blocksOf(grid, 0);
  const Relief relief(lattice, fields, bareDepth(grid));
  std::vector<Value> values;
  values.reserve(lattice.cells());
  for (std::size_t j = 0; j < lattice.rows(); ++j) {
    for (std::size_t i = 0; i < lattice.columns(); ++i) {
      const std::size_t cell = lattice.index(i, j);
      values.push_back(relief.hasLoad(cell)
                           ? function(SurfaceMaterial::sand, normalOf(relief.visibleGradient(i, j)))
                           : function(relief.material(cell), relief.groundNormal(i, j)));
    }
  }
  return values;
}

}  // namespace

std::vector<Eigen::Vector3f> visibleColours(const Grid& grid, const Fields& fields) {
  return visibleValues<Eigen::Vector3f>(grid, fields, surfaceColour);
}

std::vector<float> visibleLight(const Grid& grid, const Fields& fields) {
  return visibleValues<float>(grid, fields,
                              [](SurfaceMaterial, const Eigen::Vector3f& normal) { return lightOn(normal); });
}

}  // namespace shallow_sand
