#pragma once

#include <Eigen/Geometry>
#include <array>
#include <variant>
#include <vector>

namespace shallow_sand {

/// A closed or nearly closed surface; counter-clockwise triangles seen from outside. [m]
struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<int, 3>> triangles;

  /// Adds a copy of `other`, moved by `pose`.
  void append(const TriangleMesh& other, const Eigen::Isometry3d& pose);
};

struct Box {
  Eigen::Vector3d size;  ///< full lengths [m], centred at the origin
};
struct Cylinder {
  double radius;  ///< [m]
  double length;  ///< along z, centred at the origin [m]
};
struct Sphere {
  double radius;  ///< [m]
};
using Shape = std::variant<Box, Cylinder, Sphere, TriangleMesh>;

/// The surface of a shape as triangles (round shapes within 0.1 % of their radius).
/// @throws InvalidParameter for a size that is not positive and finite
TriangleMesh triangulate(const Shape& shape);

}  // namespace shallow_sand
