#include "shallow_sand/ros/requested_mesh.h"

#include <string>

#include "shallow_sand/bodies/robot_links.h"
#include "shallow_sand/core/parameters.h"

namespace shallow_sand {
namespace {

TriangleMesh meshOf(const shape_msgs::SolidPrimitive& shape) {
  using Solid = shape_msgs::SolidPrimitive;
  const auto require = [&shape](std::size_t count, const std::string& expected) {
    if (shape.dimensions.size() == count) return;
    throw InvalidParameter("shape.dimensions", std::to_string(shape.dimensions.size()) + " numbers",
                           expected);
  };
  switch (shape.type) {
    case Solid::BOX:
      require(3, "x, y, z of a BOX");
      return triangulate(Box{Eigen::Vector3d(shape.dimensions.data())});
    case Solid::SPHERE:
      require(1, "the radius of a SPHERE");
      return triangulate(Sphere{shape.dimensions[Solid::SPHERE_RADIUS]});
    case Solid::CYLINDER:
      require(2, "height and radius of a CYLINDER");
      return triangulate(
          Cylinder{shape.dimensions[Solid::CYLINDER_RADIUS], shape.dimensions[Solid::CYLINDER_HEIGHT]});
    default:
      throw InvalidParameter("shape.type", std::to_string(shape.type),
                             "BOX, SPHERE or CYLINDER, or a mesh instead of a shape");
  }
}

}  // namespace

TriangleMesh requestedMesh(const AddBody::Request& request) {
  if (request.mesh.empty()) return meshOf(request.shape);
  if (!request.shape.dimensions.empty()) {
    throw InvalidParameter("shape.dimensions", "given beside mesh " + request.mesh, "one of the two");
  }
  Eigen::Vector3d scale(request.scale.x, request.scale.y, request.scale.z);
  if (scale.isZero(0.0)) scale.setOnes();
  return readMesh(request.mesh, scale);
}

}  // namespace shallow_sand
