#include "shallow_sand/bodies/robot_links.h"

#include <geometric_shapes/mesh_operations.h>
#include <geometric_shapes/shapes.h>
#include <resource_retriever/retriever.h>
#include <tinyxml2.h>
#include <urdf_model/link.h>
#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>

#include <Eigen/Geometry>
#include <cctype>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <sstream>
#include <system_error>
#include <utility>

#include "shallow_sand/core/one_line.h"
#include "shallow_sand/core/parameters.h"

namespace shallow_sand {
namespace {

/// assimp needs some ten times as much memory as a file is large.
constexpr std::uintmax_t kMostBytes = std::uintmax_t{1} << 28;
constexpr unsigned int kMostTriangles = 20000000;

void requireReadable(const std::string& uri, std::uintmax_t bytes) {
  if (bytes == 0) throw InvalidParameter("mesh", "'" + uri + "', an empty file", "a mesh");
  if (bytes > kMostBytes) {
    throw InvalidParameter("mesh", "'" + uri + "', a file of " + std::to_string(bytes >> 20) + " MiB",
                           "at most " + std::to_string(kMostBytes >> 20) +
                               " MiB (a mesh editor can reduce the number of triangles)");
  }
}

/// @param uri that errors name
std::string contentOf(const std::string& path, const std::string& uri) {
  std::error_code error;
  // Of devices and pipes, from which reading might never end, there is no size.
  const std::uintmax_t bytes = std::filesystem::file_size(path, error);
  std::ifstream file;
  if (!error) file.open(path, std::ios::binary);
  if (!file.is_open()) {
    throw InvalidParameter("mesh", "'" + uri + "', which cannot be read", "a readable file");
  }
  requireReadable(uri, bytes);
  return std::string((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
}

/// %20 is a blank.
std::string decoded(const std::string& path) {
  std::string text;
  for (std::size_t k = 0; k < path.size(); ++k) {
    const auto isDigit = [&](std::size_t at) {
      return at < path.size() && std::isxdigit(static_cast<unsigned char>(path[at])) != 0;
    };
    if (path[k] == '%' && isDigit(k + 1) && isDigit(k + 2)) {
      text += static_cast<char>(std::stoi(path.substr(k + 1, 2), nullptr, 16));
      k += 2;
    } else {
      text += path[k];
    }
  }
  return text;
}

std::string retrieve(const std::string& uri) {
  if (uri.find("://") == std::string::npos) return contentOf(uri, uri);
  // The library would fetch from wherever others lead.
  if (uri.rfind("file:///", 0) == 0) {
    const std::string path = uri.substr(std::string("file://").size());
    std::error_code error;
    return contentOf(std::filesystem::exists(path, error) ? path : decoded(path), uri);
  }
  if (uri.rfind("package://", 0) != 0)
    throw InvalidParameter("mesh", "'" + uri + "'", "package://PACKAGE/PATH or file:///PATH");
  try {
    const resource_retriever::MemoryResource file = resource_retriever::Retriever().get(uri);
    requireReadable(uri, file.size);
    return std::string(reinterpret_cast<const char*>(file.data.get()), file.size);
  } catch (const resource_retriever::Exception& problem) {
    throw InvalidParameter("mesh", "'" + uri + "' (" + problem.what() + ")",
                           "a readable file as package://PACKAGE/PATH");
  }
}

/// Length of a COLLADA file's unit [m]; 1 for other files. assimp puts unit and up axis into the root node's
/// transform, which geometric_shapes drops, as rviz does; rviz then applies the unit itself.
double unitOf(const std::string& file) {
  tinyxml2::XMLDocument document;
  document.Parse(file.data(), file.size());
  const auto* unit = tinyxml2::XMLHandle(document)
                         .FirstChildElement("COLLADA")
                         .FirstChildElement("asset")
                         .FirstChildElement("unit")
                         .ToElement();
  const double meter = unit == nullptr ? 1.0 : unit->DoubleAttribute("meter", 1.0);
  return meter > 0.0 ? meter : 1.0;
}

/// A mirroring `scale` turns triangles inside out, so they are turned back.
TriangleMesh copyOf(const shapes::Mesh& source, bool mirrored) {
  TriangleMesh mesh;
  mesh.vertices.reserve(source.vertex_count);
  mesh.triangles.reserve(source.triangle_count);
  for (unsigned int i = 0; i < source.vertex_count; ++i) {
    mesh.vertices.emplace_back(Eigen::Map<const Eigen::Vector3d>(source.vertices + 3 * i));
  }
  for (unsigned int i = 0; i < source.triangle_count; ++i) {
    std::array<int, 3> triangle{};
    for (std::size_t corner = 0; corner < 3; ++corner) {
      triangle[corner] = static_cast<int>(source.triangles[3 * i + corner]);
    }
    if (mirrored) std::swap(triangle[1], triangle[2]);
    mesh.triangles.push_back(triangle);
  }
  return mesh;
}

Shape shapeOf(const urdf::Geometry& geometry) {
  switch (geometry.type) {
    case urdf::Geometry::BOX: {
      const auto& box = static_cast<const urdf::Box&>(geometry);
      return Box{{box.dim.x, box.dim.y, box.dim.z}};
    }
    case urdf::Geometry::CYLINDER: {
      const auto& cylinder = static_cast<const urdf::Cylinder&>(geometry);
      return Cylinder{cylinder.radius, cylinder.length};
    }
    case urdf::Geometry::SPHERE:
      return Sphere{static_cast<const urdf::Sphere&>(geometry).radius};
    case urdf::Geometry::MESH: {
      const auto& mesh = static_cast<const urdf::Mesh&>(geometry);
      return readMesh(mesh.filename, {mesh.scale.x, mesh.scale.y, mesh.scale.z});
    }
  }
  throw InvalidParameter("geometry", "an unknown kind", "box, cylinder, sphere or mesh");
}

Eigen::Isometry3d poseOf(const urdf::Pose& origin) {
  Eigen::Quaterniond rotation;
  origin.rotation.getQuaternion(rotation.x(), rotation.y(), rotation.z(), rotation.w());
  return Eigen::Translation3d(origin.position.x, origin.position.y, origin.position.z) *
         rotation.normalized();
}

/// urdfdom's parser goes as deep into elements as they go, until there is no stack left.
bool isTooDeep(const std::string& urdf_xml) {
  return tinyxml2::XMLDocument().Parse(urdf_xml.data(), urdf_xml.size()) ==
         tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED;
}

urdf::ModelInterfaceSharedPtr parse(const std::string& urdf_xml) {
  if (isTooDeep(urdf_xml)) {
    throw InvalidParameter(
        "robot_description",
        "elements within more than " + std::to_string(TINYXML2_MAX_ELEMENT_DEPTH) + " others", "a URDF");
  }
  std::string reason = "its log says why";
  try {
    if (const urdf::ModelInterfaceSharedPtr model = urdf::parseURDF(urdf_xml)) return model;
  } catch (const std::exception& error) {
    reason = error.what();
  }
  throw InvalidParameter("robot_description",
                         "a text of " + std::to_string(urdf_xml.size()) +
                             " characters that urdfdom can't parse (" + reason + ")",
                         "a URDF with one <robot>");
}

/// How many collision elements each link has in the text. urdfdom stops reading a link at the first that it
/// does not know (a capsule, say), logs that and goes on as if there were no more.
std::map<std::string, std::size_t> collisionsWritten(const std::string& urdf_xml) {
  tinyxml2::XMLDocument document;
  document.Parse(urdf_xml.data(), urdf_xml.size());
  std::map<std::string, std::size_t> written;
  const auto* robot = tinyxml2::XMLHandle(document).FirstChildElement("robot").ToElement();
  if (robot == nullptr) return written;
  for (const auto* link = robot->FirstChildElement("link"); link; link = link->NextSiblingElement("link")) {
    const char* name = link->Attribute("name");
    if (name == nullptr) continue;
    for (const auto* element = link->FirstChildElement("collision"); element;
         element = element->NextSiblingElement("collision")) {
      ++written[name];
    }
  }
  return written;
}

std::string cutShort(const std::string& robot, const std::string& link, std::size_t first_unread) {
  return "robot '" + robot + "', link '" + link + "', collision elements from " +
         std::to_string(first_unread) +
         " on left out: urdfdom can't parse that one, its log says why; expected box, cylinder, sphere or "
         "mesh";
}

LinkGeometry geometryOf(const urdf::Link& link, const std::string& robot,
                        std::vector<std::string>& problems) {
  LinkGeometry geometry{link.name, {}};
  int number = 0;
  for (const urdf::CollisionSharedPtr& collision : link.collision_array) {
    ++number;
    try {
      if (!collision->geometry) throw InvalidParameter("geometry", "none", "box, cylinder, sphere or mesh");
      geometry.mesh.append(triangulate(shapeOf(*collision->geometry)), poseOf(collision->origin));
    } catch (const InvalidParameter& error) {
      problems.push_back(oneLine("robot '" + robot + "', link '" + link.name + "', collision element " +
                                 std::to_string(number) + " left out: " + error.what()));
    }
  }
  return geometry;
}

}  // namespace

RobotGeometry collisionGeometry(const std::string& urdf_xml) {
  const urdf::ModelInterfaceSharedPtr model = parse(urdf_xml);
  RobotGeometry robot;
  robot.robot = model->getName();
  const std::map<std::string, std::size_t> written = collisionsWritten(urdf_xml);
  for (const auto& [name, link] : model->links_) {
    const auto count = written.find(name);
    const std::size_t known = link->collision_array.size();
    if (count != written.end() && count->second > known) {
      robot.problems.push_back(oneLine(cutShort(robot.robot, name, known + 1)));
    }
    LinkGeometry geometry = geometryOf(*link, robot.robot, robot.problems);
    if (!geometry.mesh.triangles.empty()) robot.links.push_back(std::move(geometry));
  }
  return robot;
}

TriangleMesh readMesh(const std::string& uri, const Eigen::Vector3d& scale) {
  if (!scale.allFinite() || scale.prod() == 0.0) {
    std::ostringstream found;
    found << "'" << uri << "' with scale " << scale.transpose();
    throw InvalidParameter("mesh", found.str(), "three finite factors, none zero");
  }
  const std::string file = retrieve(uri);
  // Vertices that coincide are merged, and nothing is centred. The transforms of all nodes but the root are
  // applied.
  const std::unique_ptr<shapes::Mesh> mesh(
      shapes::createMeshFromBinary(file.data(), file.size(), unitOf(file) * scale, uri));
  if (!mesh || mesh->triangle_count == 0) {
    throw InvalidParameter("mesh", "'" + uri + "', in which assimp finds no triangles",
                           "a mesh file that assimp reads: STL, COLLADA, OBJ");
  }
  if (mesh->triangle_count > kMostTriangles) {
    throw InvalidParameter("mesh", "'" + uri + "', " + std::to_string(mesh->triangle_count) + " triangles",
                           "at most " + std::to_string(kMostTriangles));
  }
  return copyOf(*mesh, scale.prod() < 0.0);
}

}  // namespace shallow_sand
