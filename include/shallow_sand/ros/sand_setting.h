#pragma once

#include <string>

#include "shallow_sand/SetSand.h"
#include "shallow_sand/core/fields.h"
#include "shallow_sand/ros/sand_bodies.h"
#include "shallow_sand/ros/service_thread.h"
#include "shallow_sand/sim/simulator.h"

namespace shallow_sand {

/// The service ~set_sand. Messages are waited for and files are read beside the sand, and so are heights of
/// cells computed; the loop waits only while the sand takes them over.
class SandSetting {
 public:
  /// All must outlive this; bodies, which know tf, and simulator are used in the loop only.
  SandSetting(const ros::NodeHandle& node, LoopCalls& loop, const SandBodies& bodies, Simulator& simulator);

 private:
  std::string set(const SetSand::Request& request, SetSand::Response& response);
  CellValues heightsFrom(const SetSand::Request& request);
  template <class Message>
  CellValues heightsFromTopic(const SetSand::Request& request, const ros::WallTime& end);
  Eigen::Isometry3d poseOf(const std::string& frame);

  const SandBodies& bodies_;
  Simulator& simulator_;
  const Grid grid_;
  ServiceThread services_;
};

}  // namespace shallow_sand
