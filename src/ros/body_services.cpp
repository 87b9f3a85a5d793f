#include "shallow_sand/ros/body_services.h"

#include <ros/console.h>

#include <sstream>

#include "shallow_sand/bodies/body_geometry.h"
#include "shallow_sand/bodies/robot_links.h"
#include "shallow_sand/ros/poses.h"

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

TriangleMesh meshOf(const AddBody::Request& request) {
  if (request.mesh.empty()) return meshOf(request.shape);
  if (!request.shape.dimensions.empty()) {
    throw InvalidParameter("shape.dimensions", "given beside mesh " + request.mesh, "one of the two");
  }
  Eigen::Vector3d scale(request.scale.x, request.scale.y, request.scale.z);
  if (scale.isZero(0.0)) scale.setOnes();
  return readMesh(request.mesh, scale);
}

/// @throws InvalidParameter if it cannot be sampled
BodyGeometry geometryOf(const AddBody::Request& request, double sand_spacing) {
  BodyGeometryOptions options;
  if (!request.mesh_as.empty()) options.shape = linkShapeFromString(request.mesh_as, "mesh_as");
  if (!request.mesh.empty()) options.cache = defaultCacheFolder();
  return makeBodyGeometry(meshOf(request), sand_spacing, options);
}

/// @throws InvalidParameter if more than one thing is to move the body
void requireOneMover(const AddBody::Request& request) {
  if (request.follow && request.pose.header.frame_id.empty())
    throw InvalidParameter("pose.header.frame_id", "empty", "the tf frame to follow");
  if (request.follow && request.handle)
    throw InvalidParameter("handle", "given beside follow", "one of the two: tf moves what follows a frame");
  if (!request.pose_topic.empty() && (request.follow || request.handle))
    throw InvalidParameter("pose_topic", "given beside follow or handle", "one of them to move the body");
}

}  // namespace

BodyServices::BodyServices(const ros::NodeHandle& node, LoopCalls& loop, CallRecord& calls,
                           const GridParameters& grid, SandBodies& bodies, TransformReader& transforms)
    : sand_spacing_(grid.spacing),
      bodies_(bodies),
      pose_topics_(node, grid.frame, transforms),
      services_(node, loop) {
  // The log tells of what was done, too: it happens seldom.
  const auto told = [](const char* service, const std::string& name, const Change& change) {
    return [=](const auto&) {
      const std::string message = change();
      ROS_INFO_STREAM(service << " " << name << ": " << message);
      return message;
    };
  };
  services_.serveChange<AddBody>(
      "add_body", calls,
      [=](const AddBody::Request& request) { return told("~add_body", request.name, adding(request)); },
      [this](const AddBody::Request& request) { checkAdding(request); });
  services_.serveChange<RemoveBody>("remove_body", calls, [=](const RemoveBody::Request& request) {
    return told("~remove_body", request.name, removing(request));
  });
  services_.serveChange<MoveBody>("move_body", calls, [=](const MoveBody::Request& request) {
    return told("~move_body", request.name, moving(request));
  });
  services_.start();
}

void BodyServices::checkAdding(const AddBody::Request& request) const {
  bodies_.requireFree(request.name);
  if (!request.follow && request.pose_topic.empty()) bodies_.poseOf(request.pose.header.frame_id);
}

Change BodyServices::adding(const AddBody::Request& request) {
  const Eigen::Isometry3d pose = rigid(request.pose.pose);
  requireOneMover(request);
  const ros::WallTime begin = ros::WallTime::now();
  const BodyGeometry geometry = geometryOf(request, sand_spacing_);
  std::ostringstream done;
  done << (geometry.from_cache ? "taken from the cache" : "sampled") << " in "
       << (ros::WallTime::now() - begin).toSec() << " s";
  for (const std::string& note : geometry.notes) done << "; " << note;
  const BodyAppearance appearance{lookOf(request), request.handle != 0};
  return [this, request, pose, field = geometry.field, appearance, message = done.str()] {
    const std::string& frame = request.pose.header.frame_id;
    if (!request.pose_topic.empty()) {
      bodies_.requireFree(request.name);
      const TfFrame own{pose_topics_.follow(request.name, request.pose_topic)};
      bodies_.addFollowing(request.name, "", own, field, appearance);
    } else if (request.follow) {
      bodies_.addFollowing(request.name, "", {frame, pose}, field, appearance);
    } else {
      bodies_.addPlaced(request.name, bodies_.poseOf(frame) * pose, field, appearance);
    }
    return message;
  };
}

Change BodyServices::removing(const RemoveBody::Request& request) {
  return [this, request] {
    bodies_.remove(request.name);
    pose_topics_.forget(request.name);
    return std::string("removed");
  };
}

Change BodyServices::moving(const MoveBody::Request& request) {
  return [this, request, pose = rigid(request.pose.pose)] {
    bodies_.move(request.name, bodies_.poseOf(request.pose.header.frame_id) * pose, request.duration);
    return request.duration > 0.0 ? "under way for " + std::to_string(request.duration) + " s"
                                  : std::string("put there");
  };
}

}  // namespace shallow_sand
