#include <ogr_geometry.h>

#include <memory>

#include "shallow_sand/scene/picture.h"

namespace shallow_sand {

Outline footprint(const TriangleMesh& mesh, const Eigen::Isometry3d& pose) {
  OGRMultiPoint points;
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    const Eigen::Vector3d position = pose * vertex;
    points.addGeometryDirectly(new OGRPoint(position.x(), position.y()));
  }
  const std::unique_ptr<OGRGeometry> hull(points.ConvexHull());
  Outline outline;
  if (hull == nullptr || wkbFlatten(hull->getGeometryType()) != wkbPolygon) {
    return outline;
  }
  for (const OGRPoint& corner : *hull->toPolygon()->getExteriorRing()) {
    outline.emplace_back(corner.getX(), corner.getY());
  }
  return outline;
}

}  // namespace shallow_sand
