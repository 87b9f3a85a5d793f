#pragma once

#include <string>

#include "shallow_sand/QuerySurface.h"
#include "shallow_sand/VolumeInPolygon.h"
#include "shallow_sand/ros/sand_bodies.h"
#include "shallow_sand/ros/service_thread.h"
#include "shallow_sand/sim/simulator.h"

namespace shallow_sand {

/// The services ~query_surface and ~volume_in_polygon: the loop copies the fields, all else goes on beside
/// the sand.
class SandQueries {
 public:
  /// All must outlive this; bodies, which know tf, and simulator are used in the loop only.
  SandQueries(const ros::NodeHandle& node, LoopCalls& loop, const SandBodies& bodies,
              const Simulator& simulator);

 private:
  std::string querySurface(const QuerySurface::Request& request, QuerySurface::Response& response);
  std::string volumeInPolygon(const VolumeInPolygon::Request& request, VolumeInPolygon::Response& response);

  const SandBodies& bodies_;
  const Simulator& simulator_;
  const Grid grid_;
  ServiceThread services_;
};

}  // namespace shallow_sand
