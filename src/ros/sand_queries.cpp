#include "shallow_sand/ros/sand_queries.h"

#include <vector>

#include "shallow_sand/ros/named_frame.h"
#include "shallow_sand/ros/query_answers.h"
#include "shallow_sand/surface/polygon_volume.h"

namespace shallow_sand {

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
  requirePoints(request);
  Eigen::Isometry3d frame;
  Fields fields;
  services_.inLoop([&] {
    frame = poseOfNamedFrame(bodies_, "header.frame_id", request.header.frame_id);
    fields = simulator_.fields();
  });
  response = surfaceAt(request, frame, grid_, fields);
  return "";
}

std::string SandQueries::volumeInPolygon(const VolumeInPolygon::Request& request,
                                         VolumeInPolygon::Response& response) {
  Eigen::Isometry3d frame;
  Fields fields;
  services_.inLoop(
      [&] { frame = poseOfNamedFrame(bodies_, "polygon.header.frame_id", request.polygon.header.frame_id); });
  const std::vector<Eigen::Vector2d> corners = requestedPolygon(request, frame);
  services_.inLoop([&] { fields = simulator_.fields(); });
  const PolygonVolume volume = shallow_sand::volumeInPolygon(grid_, fields, corners);
  response.on_ground = volume.on_ground;
  response.on_bodies = volume.on_bodies;
  response.area = volume.area;
  return "";
}

}  // namespace shallow_sand
