#include "shallow_sand/ros/requested_edits.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "shallow_sand/solver/change_sand.h"

namespace shallow_sand {
namespace {

/// Bound on lengths: what is larger is no map, and of waves on deeper sand no step is short enough. [m]
constexpr double kLongest = 1e6;
/// Of a place: UTM counts up to 1e7. [m]
constexpr double kFarthest = 1e8;

void requireWithin(double bound, const std::string& key, double value, const char* expected) {
  if (std::abs(value) <= bound) return;
  std::ostringstream found;
  found << value;
  throw InvalidParameter(key, found.str(), expected);
}

void requireBounded(const std::string& key, double length) {
  requireWithin(kLongest, key, length, "metres, at most a million");
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

Eigen::Vector3d positionOf(const std::string& key, const geometry_msgs::Point& point) {
  constexpr const char* kExpected = "metres, at most a hundred million";
  requireWithin(kFarthest, key + ".x", point.x, kExpected);
  requireWithin(kFarthest, key + ".y", point.y, kExpected);
  requireWithin(kFarthest, key + ".z", point.z, kExpected);
  return {point.x, point.y, point.z};
}

/// Area of the cells that a disc covers. [m²]
double coveredArea(const Region& disc, const Grid& grid) {
  const LocalRegion local = localRegion(disc, grid);
  const Window window = windowOf(local, grid);
  double cells = 0.0;
  for (int j = window.row_begin; j < window.row_end; ++j) {
    for (int i = window.column_begin; i < window.column_end; ++i) {
      const float x = (static_cast<float>(i) + 0.5f) * grid.spacing;
      const float y = (static_cast<float>(j) + 0.5f) * grid.spacing;
      cells += local.holds(x, y) ? 1.0 : 0.0;
    }
  }
  return cells * grid.cellArea();
}

}  // namespace

Edit requestedEdit(const EditSand::Request& request, const Eigen::Isometry3d& frame) {
  Edit edit = editOf(request);
  edit.region.center = (frame * positionOf("center.point", request.center.point)).head<2>();
  return edit;
}

Edit requestedEdit(const PourSand& message, const Eigen::Isometry3d& frame, const Grid& grid) {
  const Eigen::Vector3d position = positionOf("position.point", message.position.point);
  const double longest = grid.spacing * static_cast<double>(std::max(grid.columns, grid.rows));
  if (!(message.radius > 0.0 && message.radius <= longest)) {
    throw InvalidParameter("radius", std::to_string(message.radius),
                           "metres above 0, at most the grid's " + std::to_string(longest));
  }
  const Eigen::Vector3d in_sand = frame * position;
  Edit edit;
  edit.region.center = in_sand.head<2>();
  edit.region.radius = message.radius;
  const double area = coveredArea(edit.region, grid);
  if (!(area > 0.0)) {
    std::ostringstream found;
    found << "(" << in_sand.x() << ", " << in_sand.y() << ", " << in_sand.z() << ") in the sand's frame";
    throw InvalidParameter("position", found.str(), "a disc that covers cells of the grid");
  }
  edit.operation = message.volume < 0.0 ? EditOperation::remove : EditOperation::add;
  edit.value = std::abs(message.volume) / area;
  constexpr double kDeepest = 1e6;
  if (!(edit.value <= kDeepest)) {
    throw InvalidParameter("volume", std::to_string(message.volume),
                           "cubic metres, no more than a million metres deep on the disc");
  }
  return edit;
}

}  // namespace shallow_sand
