#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "shallow_sand/core/fields.h"
#include "shallow_sand/core/grid.h"
#include "shallow_sand/surface/surface_colour.h"

namespace shallow_sand {

/// The surface of the ground, s = h + b, from the middles of the outermost cells on: sand, cut off where it
/// is a tenth of a cell deep (section 7.2), and bare bed, which meet without a gap; and sheets of sand over
/// them.
struct SurfaceMesh {
  using Triangle = std::array<std::uint32_t, 3>;

  /// Vertices: the middles of cells in the order of Fields; then points of the shore, each twice, for the
  /// sand and for the bed, as their normals and colours differ there; then those of loads.
  std::vector<Eigen::Vector3d> positions;  ///< in the grid's frame [m]
  std::vector<Eigen::Vector3f> normals;    ///< of unit length, upward
  std::vector<SurfaceMaterial> materials;

  /// Counter-clockwise seen from above.
  std::vector<Triangle> sand;
  std::vector<Triangle> bed;
  /// Sand that lies on bodies, but nothing that hangs from it to the ground far below: where a bucket carries
  /// sand, that is a second sheet over the ground's.
  std::vector<Triangle> loads;

  std::size_t triangles() const { return sand.size() + bed.size() + loads.size(); }
  /// Calls function(triangle) for all of them.
  template <class Function>
  void forEachTriangle(const Function& function) const {
    for (const auto* triangles : {&sand, &bed, &loads}) {
      for (const Triangle& triangle : *triangles) function(triangle);
    }
  }
  Eigen::Vector3f colour(std::size_t vertex) const {
    return surfaceColour(materials[vertex], normals[vertex]);
  }
};

/// Marching triangles: each square between four middles of cells is split from south-west to north-east.
/// Shores are exact where both sand and bed are plane, else of second order. Without triangles for a grid of
/// one row or column.
/// @param level of detail; from blocks of 2^level × 2^level cells
SurfaceMesh surfaceMesh(const Grid& grid, const Fields& fields, int level = 0);

}  // namespace shallow_sand
