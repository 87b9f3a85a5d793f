#include "shallow_sand/surface/surface_colour.h"

#include "relief.h"

namespace shallow_sand {

std::vector<Eigen::Vector3f> visibleColours(const Grid& grid, const Fields& fields) {
  const Lattice lattice = blocksOf(grid, 0);
  const Relief relief(lattice, fields, bareDepth(grid));
  std::vector<Eigen::Vector3f> colours;
  colours.reserve(lattice.cells());
  for (std::size_t j = 0; j < lattice.rows(); ++j) {
    for (std::size_t i = 0; i < lattice.columns(); ++i) {
      const std::size_t cell = lattice.index(i, j);
      colours.push_back(relief.hasLoad(cell)
                            ? surfaceColour(SurfaceMaterial::sand, normalOf(relief.visibleGradient(i, j)))
                            : surfaceColour(relief.material(cell), relief.groundNormal(i, j)));
    }
  }
  return colours;
}

}  // namespace shallow_sand
