#pragma once

#include <ros/node_handle.h>

#include "shallow_sand/PourSand.h"
#include "shallow_sand/ros/call_record.h"
#include "shallow_sand/ros/sand_bodies.h"
#include "shallow_sand/sim/simulator.h"

namespace shallow_sand {

/// Subscribes to ~pour: sand is there, or gone, at once. A message that cannot be followed is refused in one
/// line of the log.
class PourTopic {
 public:
  static constexpr const char* kName = "pour";  ///< of the topic, and in CallRecord

  /// Messages are taken from the global queue, all that have come, up to a thousand between two frames.
  /// @param node whose name the topic begins with. All others must outlive this
  PourTopic(ros::NodeHandle node, CallRecord& calls, const SandBodies& bodies, Simulator& simulator);

 private:
  void take(const PourSand& message);
  /// @throws InvalidParameter, tf2::TransformException
  void pour(const PourSand& message);

  const CallRecord& calls_;
  const SandBodies& bodies_;  ///< knows tf
  Simulator& simulator_;
  ros::WallTime told_;  ///< when the log last told of a refusal
  ros::Subscriber subscriber_;
};

}  // namespace shallow_sand
