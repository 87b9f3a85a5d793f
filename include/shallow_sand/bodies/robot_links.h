#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "shallow_sand/bodies/shape.h"

namespace shallow_sand {

/// What of a link touches sand.
struct LinkGeometry {
  std::string link;
  TriangleMesh mesh;  ///< all its collision elements, in the link's frame; at least one triangle [m]
};

struct RobotGeometry {
  std::string robot;
  std::vector<LinkGeometry> links;    ///< by name; links without collision elements are not listed
  std::vector<std::string> problems;  ///< one line for each collision element left out, fit for a log
};

/// The collision geometry of a robot: of every link all boxes, cylinders, spheres and meshes. An element that
/// can't be had is left out and named in `problems`; the rest goes on.
/// @throws InvalidParameter with key `robot_description` if `urdf_xml` is no URDF
RobotGeometry collisionGeometry(const std::string& urdf_xml);

/// The triangles of a mesh file, where and as large as rviz shows them: in the file's own axes (its up axis
/// is not applied), in metres (COLLADA's `<unit meter>` is), times `scale`. `uri`: package://PACKAGE/PATH,
/// file:///PATH or the path of a file; STL, COLLADA, OBJ and whatever else assimp reads.
/// @throws InvalidParameter with key `mesh` if the file can't be read, is larger than 256 MiB, holds no
/// triangle or more than 20 million, or `scale` is zero or not finite
TriangleMesh readMesh(const std::string& uri, const Eigen::Vector3d& scale);

}  // namespace shallow_sand
