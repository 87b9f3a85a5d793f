#pragma once

#include <ros/node_handle.h>
#include <visualization_msgs/MarkerArray.h>

#include <string>
#include <vector>

#include "shallow_sand/ros/sand_bodies.h"

namespace shallow_sand {

/// Publishes ~bodies, latched: all bodies that are shown, each time that one has come, moved or gone.
class BodyMarkers {
 public:
  /// @param node whose name the topic begins with
  BodyMarkers(ros::NodeHandle node, const std::string& sand_frame);
  void update(const std::vector<ShownBody>& bodies);

 private:
  std::string sand_frame_;
  ros::Publisher publisher_;
  visualization_msgs::MarkerArray last_;  ///< of bodies that are there
};

}  // namespace shallow_sand
