#pragma once

#include <functional>
#include <string>

#include "shallow_sand/EditSand.h"
#include "shallow_sand/ros/sand_bodies.h"
#include "shallow_sand/ros/service_thread.h"
#include "shallow_sand/sim/simulator.h"

namespace shallow_sand {

/// The service ~edit_sand. It answers when the frame that the sand is at has ended.
class SandEditing {
 public:
  /// All must outlive this; bodies, which know tf, and simulator are used in the loop only.
  SandEditing(const ros::NodeHandle& node, LoopCalls& loop, CallRecord& calls, const SandBodies& bodies,
              Simulator& simulator);

 private:
  std::function<std::string(EditSand::Response&)> editing(const EditSand::Request& request);

  const SandBodies& bodies_;
  Simulator& simulator_;
  ServiceThread services_;
};

}  // namespace shallow_sand
