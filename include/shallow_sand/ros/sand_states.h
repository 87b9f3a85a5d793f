#pragma once

#include <ros/time.h>

#include <future>
#include <string>

#include "shallow_sand/StateFile.h"
#include "shallow_sand/ros/node_parameters.h"
#include "shallow_sand/ros/sand_bodies.h"
#include "shallow_sand/ros/service_thread.h"
#include "shallow_sand/sim/simulator.h"

namespace shallow_sand {

/// States of the sand in files within ~state_folder: the services ~save and ~load, the snapshots that are
/// taken every ~snapshot_period, and the one from which ~restore goes on. Files are written and read beside
/// the sand, which waits only until its fields are copied.
class SandStates {
 public:
  /// All must outlive this; bodies and simulator are used in the loop only. Restores the state if the
  /// parameters want it: a file that cannot be used is set aside, and one line of the log says so.
  SandStates(const ros::NodeHandle& node, LoopCalls& loop, const NodeParameters& parameters,
             SandBodies& bodies, Simulator& simulator);
  /// To be called by the loop between frames: takes the snapshot that is due, unless the one before is still
  /// being written.
  void saveIfDue();

 private:
  std::string save(const std::string& name);
  std::string load(const std::string& name);
  void restore();
  void goOnFrom(Snapshot state);
  void tellProblem();

  const NodeParameters& parameters_;
  SandBodies& bodies_;
  Simulator& simulator_;
  double last_;                       ///< simulated time of the last snapshot [s]
  std::future<std::string> writing_;  ///< what was wrong with it, empty if nothing was
  ros::WallTime told_;
  ServiceThread services_;
};

}  // namespace shallow_sand
