#pragma once

#include <ros/node_handle.h>

#include <memory>
#include <string>

#include "shallow_sand/ros/link_loader.h"
#include "shallow_sand/ros/node_parameters.h"
#include "shallow_sand/ros/sand_bodies.h"

namespace shallow_sand {

/// Brings one robot's links into the sand: waits for its description, which may come later than the node, and
/// hands its links over as they become ready. The log tells once of what keeps it away.
class Robot {
 public:
  /// @param alone no other robot is there, so that links go by their own names
  Robot(const RobotParameters& parameters, bool alone, double sand_spacing);
  /// To be called each frame.
  void update(const ros::NodeHandle& node, SandBodies& bodies);

 private:
  void findDescription(const ros::NodeHandle& node);
  void addLink(const LinkLoader::Link& link, SandBodies& bodies) const;
  void describe(const std::string& problem);

  RobotParameters parameters_;
  bool alone_;
  double sand_spacing_;
  std::unique_ptr<LinkLoader> loader_;
  std::string urdf_;  ///< that was given to a loader last
  ros::WallTime last_search_;
  std::string described_problem_;  ///< told last
};

}  // namespace shallow_sand
