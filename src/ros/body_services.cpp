#include "shallow_sand/ros/body_services.h"

#include <ros/console.h>
#include <ros/init.h>

#include <chrono>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>

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

/// Runs a request and puts into words how it ended.
template <class Response, class Action>
bool answer(const std::string& request, Response& response, const Action& action) {
  response.success = false;
  try {
    response.message = action();
    response.success = true;
    ROS_INFO_STREAM(request << ": " << response.message);
  } catch (const std::exception& problem) {
    response.message = problem.what();
    ROS_WARN_STREAM(request << " is refused: " << response.message);
  }
  // False would be a failure of the call, without a message.
  return true;
}

}  // namespace

BodyServices::BodyServices(ros::NodeHandle node, double sand_spacing, SandBodies& bodies)
    : sand_spacing_(sand_spacing), bodies_(bodies) {
  node.setCallbackQueue(&queue_);
  add_ = node.advertiseService("add_body", &BodyServices::add, this);
  remove_ = node.advertiseService("remove_body", &BodyServices::remove, this);
  move_ = node.advertiseService("move_body", &BodyServices::move, this);
  spinner_.start();
}

void BodyServices::runPending() {
  std::packaged_task<void()> task;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::swap(task, pending_);
  }
  if (task.valid()) task();
}

void BodyServices::inLoop(const std::function<void()>& action) {
  std::packaged_task<void()> task(action);
  std::future<void> done = task.get_future();
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    pending_ = std::move(task);
  }
  while (done.wait_for(std::chrono::milliseconds(100)) != std::future_status::ready) {
    if (ros::ok()) continue;
    // The loop ends. If it has not taken the task yet it must not, for what that refers to goes now.
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!pending_.valid()) continue;
    pending_ = {};
    throw std::runtime_error("the node is shutting down");
  }
  done.get();
}

bool BodyServices::add(AddBody::Request& request, AddBody::Response& response) {
  return answer("~add_body " + request.name, response, [&] {
    const std::string& frame = request.pose.header.frame_id;
    const Eigen::Isometry3d pose = rigid(request.pose.pose);
    if (request.follow && frame.empty()) {
      throw InvalidParameter("pose.header.frame_id", "empty", "the tf frame to follow");
    }
    if (request.follow && request.handle) {
      throw InvalidParameter("handle", "given beside follow",
                             "one of the two: tf moves what follows a frame");
    }
    inLoop([&] {
      bodies_.requireFree(request.name);
      if (!request.follow) bodies_.poseOf(frame);
    });
    const ros::WallTime begin = ros::WallTime::now();
    const BodyGeometry geometry = geometryOf(request, sand_spacing_);
    const double duration = (ros::WallTime::now() - begin).toSec();
    const BodyAppearance appearance{lookOf(request), request.handle != 0};
    inLoop([&] {
      if (request.follow) {
        bodies_.addFollowing(request.name, "", {frame, pose}, geometry.field, appearance);
      } else {
        bodies_.addPlaced(request.name, bodies_.poseOf(frame) * pose, geometry.field, appearance);
      }
    });
    std::ostringstream done;
    done << (geometry.from_cache ? "taken from the cache" : "sampled") << " in " << duration << " s";
    for (const std::string& note : geometry.notes) done << "; " << note;
    return done.str();
  });
}

bool BodyServices::remove(RemoveBody::Request& request, RemoveBody::Response& response) {
  return answer("~remove_body " + request.name, response, [&] {
    inLoop([&] { bodies_.remove(request.name); });
    return std::string("removed");
  });
}

bool BodyServices::move(MoveBody::Request& request, MoveBody::Response& response) {
  return answer("~move_body " + request.name, response, [&] {
    const Eigen::Isometry3d pose = rigid(request.pose.pose);
    inLoop([&] {
      bodies_.move(request.name, bodies_.poseOf(request.pose.header.frame_id) * pose, request.duration);
    });
    return request.duration > 0.0 ? "under way for " + std::to_string(request.duration) + " s"
                                  : std::string("put there");
  });
}

}  // namespace shallow_sand
