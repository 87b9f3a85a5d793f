#include <fcl/geometry/shape/utility.h>
#include <fcl/math/bv/OBB.h>
#include <fcl/math/bv/utility.h>
#include <geometric_shapes/bodies.h>
#include <geometric_shapes/mesh_operations.h>
#include <geometric_shapes/shapes.h>

#include <array>
#include <memory>
#include <string>
#include <utility>

#include "shallow_sand/bodies/body_geometry.h"
#include "shallow_sand/core/parameters.h"

namespace shallow_sand {
namespace {

/// The vertices that triangles use; a mesh may hold others.
EigenSTL::vector_Vector3d cornersOf(const TriangleMesh& mesh) {
  EigenSTL::vector_Vector3d corners;
  corners.reserve(3 * mesh.triangles.size());
  for (const std::array<int, 3>& triangle : mesh.triangles) {
    for (const int corner : triangle) corners.push_back(mesh.vertices.at(static_cast<std::size_t>(corner)));
  }
  return corners;
}

TriangleMesh convexHull(const EigenSTL::vector_Vector3d& corners) {
  const std::unique_ptr<shapes::Mesh> source(shapes::createMeshFromVertices(corners));
  const bodies::ConvexMesh hull(source.get());
  TriangleMesh mesh;
  mesh.vertices.assign(hull.getVertices().begin(), hull.getVertices().end());
  Eigen::Vector3d inside = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& vertex : mesh.vertices)
    inside += vertex / static_cast<double>(mesh.vertices.size());
  const std::vector<unsigned int>& indices = hull.getTriangles();
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    const Eigen::Vector3d& a = mesh.vertices.at(indices[i]);
    const Eigen::Vector3d& b = mesh.vertices.at(indices[i + 1]);
    const Eigen::Vector3d& c = mesh.vertices.at(indices[i + 2]);
    std::array<int, 3> triangle{static_cast<int>(indices[i]), static_cast<int>(indices[i + 1]),
                                static_cast<int>(indices[i + 2])};
    // They come in either order.
    if ((b - a).cross(c - a).dot(a - inside) < 0.0) std::swap(triangle[1], triangle[2]);
    mesh.triangles.push_back(triangle);
  }
  if (mesh.triangles.empty()) {
    throw InvalidParameter("mesh", "a flat mesh or a line, which has no convex hull",
                           "exact or bounding_box");
  }
  return mesh;
}

TriangleMesh boxAt(const Eigen::Vector3d& size, const Eigen::Isometry3d& pose) {
  TriangleMesh mesh = triangulate(Box{Eigen::Vector3d::Ones()});
  for (Eigen::Vector3d& vertex : mesh.vertices) vertex = pose * size.cwiseProduct(vertex);
  return mesh;
}

TriangleMesh boundingBox(const EigenSTL::vector_Vector3d& corners) {
  Eigen::AlignedBox3d straight;
  for (const Eigen::Vector3d& corner : corners) straight.extend(corner);
  fcl::OBB<double> turned;
  fcl::fit(corners.data(), static_cast<int>(corners.size()), turned);
  if (turned.volume() < straight.volume()) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = turned.axis;
    pose.translation() = turned.To;
    return boxAt(2.0 * turned.extent, pose);
  }
  return boxAt(straight.sizes(), Eigen::Isometry3d(Eigen::Translation3d(straight.center())));
}

}  // namespace

LinkShape linkShapeFromString(const std::string& name, const std::string& key) {
  if (name == "exact") return LinkShape::exact;
  if (name == "convex_hull") return LinkShape::convex_hull;
  if (name == "bounding_box") return LinkShape::bounding_box;
  throw InvalidParameter(key, name, "exact, convex_hull or bounding_box");
}

TriangleMesh enclosingMesh(const TriangleMesh& mesh, LinkShape shape) {
  if (shape == LinkShape::exact) return mesh;
  const EigenSTL::vector_Vector3d corners = cornersOf(mesh);
  if (corners.empty()) throw InvalidParameter("mesh", "no triangles", "at least one");
  return shape == LinkShape::convex_hull ? convexHull(corners) : boundingBox(corners);
}

}  // namespace shallow_sand
