#include "shallow_sand/ros/body_look.h"

#include <variant>

namespace shallow_sand {
namespace {

using visualization_msgs::Marker;

Marker lookOf(int type, const Eigen::Vector3d& scale) {
  Marker look;
  look.type = type;
  look.scale.x = scale.x();
  look.scale.y = scale.y();
  look.scale.z = scale.z();
  look.color.r = 0.55f;
  look.color.g = 0.6f;
  look.color.b = 0.65f;
  look.color.a = 1.0f;
  return look;
}

Marker lookOfMesh(const std::string& uri, const Eigen::Vector3d& scale) {
  Marker look = lookOf(Marker::MESH_RESOURCE, scale);
  look.mesh_resource = uri.find("://") == std::string::npos ? "file://" + uri : uri;
  return look;
}

Marker lookOfSphere(double radius) { return lookOf(Marker::SPHERE, Eigen::Vector3d::Constant(2.0 * radius)); }

Marker lookOfCylinder(double radius, double length) {
  return lookOf(Marker::CYLINDER, {2.0 * radius, 2.0 * radius, length});
}

}  // namespace

Marker lookOf(const SceneBody& body) {
  if (const Box* box = std::get_if<Box>(&body.shape)) return lookOf(Marker::CUBE, box->size);
  if (const Sphere* sphere = std::get_if<Sphere>(&body.shape)) return lookOfSphere(sphere->radius);
  if (const Cylinder* cylinder = std::get_if<Cylinder>(&body.shape))
    return lookOfCylinder(cylinder->radius, cylinder->length);
  return lookOfMesh(body.mesh_uri, body.mesh_scale);
}

Marker lookOf(const AddBody::Request& request) {
  using Solid = shape_msgs::SolidPrimitive;
  if (!request.mesh.empty()) {
    const Eigen::Vector3d scale(request.scale.x, request.scale.y, request.scale.z);
    return lookOfMesh(request.mesh, scale.isZero(0.0) ? Eigen::Vector3d::Ones() : scale);
  }
  const std::vector<double>& size = request.shape.dimensions;
  if (request.shape.type == Solid::SPHERE) return lookOfSphere(size[Solid::SPHERE_RADIUS]);
  if (request.shape.type == Solid::CYLINDER)
    return lookOfCylinder(size[Solid::CYLINDER_RADIUS], size[Solid::CYLINDER_HEIGHT]);
  return lookOf(Marker::CUBE, {size[Solid::BOX_X], size[Solid::BOX_Y], size[Solid::BOX_Z]});
}

}  // namespace shallow_sand
