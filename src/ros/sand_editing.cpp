#include "shallow_sand/ros/sand_editing.h"

#include <cmath>
#include <sstream>

#include "shallow_sand/ros/named_frame.h"

namespace shallow_sand {
namespace {

/// Bound on lengths: what is larger is no map, and of waves on deeper sand no step is short enough. [m]
constexpr double kLongest = 1e6;

void requireBounded(const std::string& key, double length) {
  if (std::abs(length) <= kLongest) return;
  std::ostringstream found;
  found << length;
  throw InvalidParameter(key, found.str(), "metres, at most a million");
}

Region::Shape shapeOf(const EditSand::Request& request) {
  switch (request.shape) {
    case EditSand::Request::DISC:
      return Region::Shape::disc;
    case EditSand::Request::RECTANGLE:
      return Region::Shape::rectangle;
    default:
      throw InvalidParameter("shape", std::to_string(request.shape), "DISC or RECTANGLE");
  }
}

EditOperation operationOf(const EditSand::Request& request) {
  switch (request.operation) {
    case EditSand::Request::ADD:
      return EditOperation::add;
    case EditSand::Request::REMOVE:
      return EditOperation::remove;
    case EditSand::Request::SET:
      return EditOperation::set;
    case EditSand::Request::LEVEL:
      return EditOperation::level;
    default:
      throw InvalidParameter("operation", std::to_string(request.operation), "ADD, REMOVE, SET or LEVEL");
  }
}

/// But for its place.
Edit editOf(const EditSand::Request& request) {
  Edit edit;
  edit.region.shape = shapeOf(request);
  edit.region.radius = request.radius;
  edit.region.size = {request.size_x, request.size_y};
  edit.operation = operationOf(request);
  edit.value = request.value;
  edit.validate();
  requireBounded("value", edit.value);
  if (edit.region.shape == Region::Shape::disc) {
    requireBounded("radius", edit.region.radius);
  } else {
    requireBounded("size_x", edit.region.size.x());
    requireBounded("size_y", edit.region.size.y());
  }
  return edit;
}

Eigen::Vector3d positionOf(const geometry_msgs::Point& point) {
  requireBounded("center.point.x", point.x);
  requireBounded("center.point.y", point.y);
  requireBounded("center.point.z", point.z);
  return {point.x, point.y, point.z};
}

}  // namespace

SandEditing::SandEditing(const ros::NodeHandle& node, LoopCalls& loop, CallRecord& calls,
                         const SandBodies& bodies, Simulator& simulator)
    : bodies_(bodies), simulator_(simulator), services_(node, loop) {
  services_.serveChange<EditSand>("edit_sand", calls,
                                  [this](const EditSand::Request& request) { return editing(request); });
  services_.start();
}

std::function<std::string(EditSand::Response&)> SandEditing::editing(const EditSand::Request& request) {
  return [this, edit = editOf(request), center = positionOf(request.center.point),
          frame = request.center.header.frame_id](EditSand::Response& response) mutable {
    const auto pose = poseOfNamedFrame(bodies_, "center.header.frame_id", frame);
    edit.region.center = (pose * center).head<2>();
    response.volume = simulator_.edit(edit);
    std::ostringstream done;
    done << "the sand grew by " << response.volume << " m3";
    return done.str();
  };
}

}  // namespace shallow_sand
