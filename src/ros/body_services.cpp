#include "shallow_sand/ros/body_services.h"

#include <ros/console.h>

#include <algorithm>
#include <cctype>
#include <sstream>

#include "shallow_sand/bodies/body_geometry.h"
#include "shallow_sand/ros/poses.h"
#include "shallow_sand/ros/requested_mesh.h"

namespace shallow_sand {
namespace {

/// Every ~status repeats names, and so does every line of the log about a body.
void requireName(const std::string& key, const std::string& name) {
  constexpr std::size_t kLongest = 255;
  const bool is_line =
      std::none_of(name.begin(), name.end(), [](unsigned char letter) { return std::iscntrl(letter) != 0; });
  if (is_line && name.size() <= kLongest) return;
  throw InvalidParameter(key, name,
                         "at most " + std::to_string(kLongest) + " bytes without control characters");
}

/// @throws InvalidParameter if it cannot be sampled
BodyGeometry geometryOf(const AddBody::Request& request, double sand_spacing) {
  BodyGeometryOptions options;
  if (!request.mesh_as.empty()) options.shape = linkShapeFromString(request.mesh_as, "mesh_as");
  if (!request.mesh.empty()) options.cache = defaultCacheFolder();
  return makeBodyGeometry(requestedMesh(request), sand_spacing, options);
}

}  // namespace

BodyServices::BodyServices(const ros::NodeHandle& node, LoopCalls& loop, const GridParameters& grid,
                           SandBodies& bodies, TransformReader& transforms)
    : sand_spacing_(grid.spacing),
      bodies_(bodies),
      pose_topics_(node, grid.frame, transforms),
      services_(node, loop) {
  // The log tells of what was done, too: it happens seldom.
  const auto told = [](const char* service, const std::string& name, const std::string& message) {
    ROS_INFO_STREAM(service << " " << name << ": " << message);
    return message;
  };
  services_.serve<AddBody>("add_body", [=](const AddBody::Request& request, AddBody::Response&) {
    return told("~add_body", request.name, add(request));
  });
  services_.serve<RemoveBody>("remove_body", [=](const RemoveBody::Request& request, RemoveBody::Response&) {
    return told("~remove_body", request.name, remove(request));
  });
  services_.serve<MoveBody>("move_body", [=](const MoveBody::Request& request, MoveBody::Response&) {
    return told("~move_body", request.name, move(request));
  });
  services_.start();
}

std::string BodyServices::add(const AddBody::Request& request) {
  requireName("name", request.name);
  const std::string& frame = request.pose.header.frame_id;
  const Eigen::Isometry3d pose = rigid(request.pose.pose);
  if (request.follow && frame.empty()) {
    throw InvalidParameter("pose.header.frame_id", "empty", "the tf frame to follow");
  }
  if (request.follow) requireName("pose.header.frame_id", frame);
  if (request.follow && request.handle) {
    throw InvalidParameter("handle", "given beside follow", "one of the two: tf moves what follows a frame");
  }
  const bool has_topic = !request.pose_topic.empty();
  if (has_topic && (request.follow || request.handle)) {
    throw InvalidParameter("pose_topic", "given beside follow or handle", "one of them to move the body");
  }
  services_.inLoop([&] {
    bodies_.requireFree(request.name);
    if (!request.follow && !has_topic) bodies_.poseOf(frame);
  });
  const ros::WallTime begin = ros::WallTime::now();
  const BodyGeometry geometry = geometryOf(request, sand_spacing_);
  const double duration = (ros::WallTime::now() - begin).toSec();
  const BodyAppearance appearance{lookOf(request), request.handle != 0};
  services_.inLoop([&] {
    if (has_topic) {
      const TfFrame own{pose_topics_.follow(request.name, request.pose_topic)};
      bodies_.addFollowing(request.name, "", own, geometry.field, appearance);
    } else if (request.follow) {
      bodies_.addFollowing(request.name, "", {frame, pose}, geometry.field, appearance);
    } else {
      bodies_.addPlaced(request.name, bodies_.poseOf(frame) * pose, geometry.field, appearance);
    }
  });
  std::ostringstream done;
  done << (geometry.from_cache ? "taken from the cache" : "sampled") << " in " << duration << " s";
  for (const std::string& note : geometry.notes) done << "; " << note;
  return done.str();
}

std::string BodyServices::remove(const RemoveBody::Request& request) {
  services_.inLoop([&] {
    bodies_.remove(request.name);
    pose_topics_.forget(request.name);
  });
  return "removed";
}

std::string BodyServices::move(const MoveBody::Request& request) {
  const Eigen::Isometry3d pose = rigid(request.pose.pose);
  services_.inLoop([&] {
    bodies_.move(request.name, bodies_.poseOf(request.pose.header.frame_id) * pose, request.duration);
  });
  return request.duration > 0.0 ? "under way for " + std::to_string(request.duration) + " s" : "put there";
}

}  // namespace shallow_sand
