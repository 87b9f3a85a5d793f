#pragma once

#include <algorithm>
#include <cmath>

#include "fuzz/outcome.h"
#include "shallow_sand/bodies/body_geometry.h"

namespace shallow_sand {

/// Cells of sand that are large enough for a body to be sampled in no time. [m]
inline double quickSpacing(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : mesh.vertices) box.extend(vertex);
  const double extent = box.isEmpty() ? 0.0 : box.sizes().maxCoeff();
  return std::isfinite(extent) ? std::max(1.0, extent / 2.0) : 1.0;
}

/// Whether it takes no time to sample a mesh.
inline bool isQuick(const TriangleMesh& mesh) { return mesh.triangles.size() <= 100; }

inline void requireLaws(const TriangleMesh& mesh) {
  for (const auto& triangle : mesh.triangles) {
    for (const int corner : triangle) {
      require(corner >= 0 && static_cast<std::size_t>(corner) < mesh.vertices.size(),
              "triangles have corners that are there");
    }
  }
}

inline void requireLaws(const BodyGeometry& body) {
  const DistanceField& field = *body.field;
  require(std::isfinite(field.spacing) && field.spacing > 0.0 && field.origin.allFinite(),
          "a distance field lies somewhere");
  const auto samples = static_cast<std::size_t>(field.samples[0]) *
                       static_cast<std::size_t>(field.samples[1]) *
                       static_cast<std::size_t>(field.samples[2]);
  require(samples == field.distance.size(), "a distance field has all its samples");
  require(std::all_of(field.distance.begin(), field.distance.end(),
                      [](float distance) { return std::isfinite(distance); }),
          "distances are finite");
}

}  // namespace shallow_sand
