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
  requireName("name", request.name);
  if (request.follow) requireName("pose.header.frame_id", request.pose.header.frame_id);
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
