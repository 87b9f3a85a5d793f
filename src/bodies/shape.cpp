#include "shallow_sand/bodies/shape.h"

#include <geometric_shapes/mesh_operations.h>
#include <geometric_shapes/shapes.h>

#include <cmath>
#include <memory>
#include <string>

#include "shallow_sand/core/parameters.h"

namespace shallow_sand {
namespace {

void requireLength(const std::string& key, double length) {
  if (!std::isfinite(length) || length <= 0.0) {
    throw InvalidParameter(key, std::to_string(length), "a positive, finite length in metres");
  }
}

/// geometric_shapes' triangles of `shape`, which come counter-clockwise, stretched along the axes by `scale`.
TriangleMesh stretched(const shapes::Shape& shape, const Eigen::Vector3d& scale) {
  const std::unique_ptr<shapes::Mesh> source(shapes::createMeshFromShape(&shape));
  TriangleMesh mesh;
  for (unsigned int i = 0; i < source->vertex_count; ++i) {
    mesh.vertices.emplace_back(
        scale.cwiseProduct(Eigen::Map<const Eigen::Vector3d>(source->vertices + 3 * i)));
  }
  for (unsigned int i = 0; i < source->triangle_count; ++i) {
    const unsigned int* corners = source->triangles + 3 * i;
    mesh.triangles.push_back(
        {static_cast<int>(corners[0]), static_cast<int>(corners[1]), static_cast<int>(corners[2])});
  }
  return mesh;
}

// geometric_shapes cuts round shapes finer the larger they are: a wheel of 6 cm radius gets six sides. So one
// reference of a size at which its cut is fine enough is stretched to the size asked for.

TriangleMesh triangulated(const Box& box) {
  for (int axis = 0; axis < 3; ++axis) requireLength("shape.box", box.size[axis]);
  return stretched(shapes::Box(1.0, 1.0, 1.0), box.size);
}

/// A hundred sides: flat faces lie at most 1 − cos(π/100) = 0.05 % of the radius inside.
TriangleMesh triangulated(const Cylinder& cylinder) {
  requireLength("shape.cylinder.radius", cylinder.radius);
  requireLength("shape.cylinder.length", cylinder.length);
  const double reference_length = 0.05;  // shorter than a side, or the library cuts it along its length too
  return stretched(shapes::Cylinder(1.0, reference_length),
                   {cylinder.radius, cylinder.radius, cylinder.length / reference_length});
}

/// At the reference radius of 0.2 m: 126 meridians and 41 bands, whose faces lie at most
/// (1 − cos(π/126)) + (1 − cos(π/82)) = 0.105 % of the radius inside. Blown up by half of that, they lie as
/// far outside as inside.
TriangleMesh triangulated(const Sphere& sphere) {
  requireLength("shape.sphere", sphere.radius);
  const double reference_radius = 0.2;
  const double blow_up = 1.0005;
  return stretched(shapes::Sphere(reference_radius),
                   Eigen::Vector3d::Constant(blow_up * sphere.radius / reference_radius));
}

TriangleMesh triangulated(const TriangleMesh& mesh) { return mesh; }

}  // namespace

void TriangleMesh::append(const TriangleMesh& other, const Eigen::Isometry3d& pose) {
  const int offset = static_cast<int>(vertices.size());
  const std::size_t count = other.triangles.size();  // `other` may be this mesh itself
  const std::size_t vertex_count = other.vertices.size();
  for (std::size_t i = 0; i < vertex_count; ++i) vertices.push_back(pose * other.vertices[i]);
  for (std::size_t i = 0; i < count; ++i) {
    const std::array<int, 3> corners = other.triangles[i];
    triangles.push_back({corners[0] + offset, corners[1] + offset, corners[2] + offset});
  }
}

TriangleMesh triangulate(const Shape& shape) {
  return std::visit([](const auto& chosen) { return triangulated(chosen); }, shape);
}

}  // namespace shallow_sand
