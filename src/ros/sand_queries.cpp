#include "shallow_sand/ros/sand_queries.h"

#include <cmath>
#include <limits>
#include <sstream>

#include "shallow_sand/ros/named_frame.h"
#include "shallow_sand/surface/polygon_volume.h"
#include "shallow_sand/surface/surface_query.h"

namespace shallow_sand {
namespace {

constexpr std::size_t kMostPoints = 100000;

void requirePoints(const std::vector<geometry_msgs::Point>& points) {
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

SandQueries::SandQueries(const ros::NodeHandle& node, LoopCalls& loop, const SandBodies& bodies,
                         const Simulator& simulator)
    : bodies_(bodies), simulator_(simulator), grid_(simulator.grid()), services_(node, loop) {
  services_.serve<QuerySurface>(
      "query_surface", [this](const QuerySurface::Request& request, QuerySurface::Response& response) {
        return querySurface(request, response);
      });
  services_.serve<VolumeInPolygon>("volume_in_polygon", [this](const VolumeInPolygon::Request& request,
                                                               VolumeInPolygon::Response& response) {
    return volumeInPolygon(request, response);
  });
  services_.start();
}

std::string SandQueries::querySurface(const QuerySurface::Request& request,
                                      QuerySurface::Response& response) {
  requirePoints(request.points);
  Eigen::Isometry3d frame;
  Fields fields;
  services_.inLoop([&] {
    frame = poseOfNamedFrame(bodies_, "header.frame_id", request.header.frame_id);
    fields = simulator_.fields();
  });
  const Eigen::Isometry3d to_frame = frame.inverse();
  const Eigen::Vector3d unknown = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  for (const geometry_msgs::Point& point : request.points) {
    const Eigen::Vector2d place = (frame * Eigen::Vector3d(point.x, point.y, point.z)).head<2>();
    if (const auto found = surfaceAt(grid_, fields, place)) {
      const Eigen::Vector3d position(place.x(), place.y(), found->height);
      append(to_frame * position, to_frame.linear() * found->normal, found->depth, true, response);
    } else {
      append(unknown, unknown, unknown.x(), false, response);
    }
  }
  return "";
}

std::string SandQueries::volumeInPolygon(const VolumeInPolygon::Request& request,
                                         VolumeInPolygon::Response& response) {
  Eigen::Isometry3d frame;
  Fields fields;
  const auto& points = request.polygon.polygon.points;
  std::vector<Eigen::Vector2d> corners;
  services_.inLoop(
      [&] { frame = poseOfNamedFrame(bodies_, "polygon.header.frame_id", request.polygon.header.frame_id); });
  for (const geometry_msgs::Point32& point : points) {
    corners.push_back((frame * Eigen::Vector3f(point.x, point.y, point.z).cast<double>()).head<2>());
  }
  requireSimplePolygon(corners);
  services_.inLoop([&] { fields = simulator_.fields(); });
  const PolygonVolume volume = shallow_sand::volumeInPolygon(grid_, fields, corners);
  response.on_ground = volume.on_ground;
  response.on_bodies = volume.on_bodies;
  response.area = volume.area;
  return "";
}

}  // namespace shallow_sand
