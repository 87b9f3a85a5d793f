#pragma once

#include <diagnostic_updater/diagnostic_updater.h>

#include <optional>
#include <string>
#include <vector>

#include "shallow_sand/Status.h"
#include "shallow_sand/ros/judgements.h"

namespace shallow_sand {

/// Publishes on /diagnostics, once a second of the wall clock, whether ROS time runs or not: solver, volume,
/// bodies, backend, publishers. Figures are those of ~status.
class Diagnostics {
 public:
  /// @param private_node whose name messages bear
  /// @param silences of publishers, see judgePublishers
  Diagnostics(const ros::NodeHandle& node, const ros::NodeHandle& private_node, Backend wanted,
              const Simulator& simulator, const std::vector<std::string>& silences);

  /// ROS time has gone on by `asked`, of which the sand followed `simulated`. [s]
  void noteFrame(double asked, double simulated);
  /// What ~status says from now on.
  void take(const Status& status) { status_ = status; }
  void publishIfDue();

 private:
  void add(const std::string& name, std::function<Judgement()> judge);

  Pace pace_;  ///< since the last message
  std::optional<Status> status_;
  ros::WallTime next_;
  diagnostic_updater::Updater updater_;
};

}  // namespace shallow_sand
