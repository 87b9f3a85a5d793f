#include "shallow_sand/ros/query_answers.h"

#include <cmath>
#include <limits>
#include <sstream>
#include <string>

#include "shallow_sand/core/parameters.h"
#include "shallow_sand/surface/polygon_volume.h"
#include "shallow_sand/surface/surface_query.h"

namespace shallow_sand {
namespace {

constexpr std::size_t kMostPoints = 100000;

template <class Message>
Message toMessage(const Eigen::Vector3d& vector) {
  Message message;
  message.x = vector.x();
  message.y = vector.y();
  message.z = vector.z();
  return message;
}

void append(const Eigen::Vector3d& position, const Eigen::Vector3d& normal, double depth, bool inside,
            QuerySurface::Response& response) {
  response.surface.push_back(toMessage<geometry_msgs::Point>(position));
  response.normal.push_back(toMessage<geometry_msgs::Vector3>(normal));
  response.depth.push_back(depth);
  response.inside.push_back(inside);
}

}  // namespace

void requirePoints(const QuerySurface::Request& request) {
  const std::vector<geometry_msgs::Point>& points = request.points;
  if (points.size() > kMostPoints) {
    throw InvalidParameter("points", std::to_string(points.size()), "at most " + std::to_string(kMostPoints));
  }
  for (std::size_t k = 0; k < points.size(); ++k) {
    const geometry_msgs::Point& p = points[k];
    if (std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) continue;
    std::ostringstream found;
    found << "(" << p.x << ", " << p.y << ", " << p.z << ")";
    throw InvalidParameter("points[" + std::to_string(k) + "]", found.str(), "finite numbers");
  }
}

QuerySurface::Response surfaceAt(const QuerySurface::Request& request, const Eigen::Isometry3d& frame,
                                 const Grid& grid, const Fields& fields) {
  QuerySurface::Response response;
  const Eigen::Isometry3d to_frame = frame.inverse();
  const Eigen::Vector3d unknown = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  for (const geometry_msgs::Point& point : request.points) {
    const Eigen::Vector2d place = (frame * Eigen::Vector3d(point.x, point.y, point.z)).head<2>();
    if (const auto found = surfaceAt(grid, fields, place)) {
      const Eigen::Vector3d position(place.x(), place.y(), found->height);
      append(to_frame * position, to_frame.linear() * found->normal, found->depth, true, response);
    } else {
      append(unknown, unknown, unknown.x(), false, response);
    }
  }
  return response;
}

std::vector<Eigen::Vector2d> requestedPolygon(const VolumeInPolygon::Request& request,
                                              const Eigen::Isometry3d& frame) {
  std::vector<Eigen::Vector2d> corners;
  for (const geometry_msgs::Point32& point : request.polygon.polygon.points) {
    corners.push_back((frame * Eigen::Vector3f(point.x, point.y, point.z).cast<double>()).head<2>());
  }
  requireSimplePolygon(corners);
  return corners;
}

}  // namespace shallow_sand
