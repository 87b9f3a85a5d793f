#pragma once

#include <ros/node_handle.h>

#include <string>

#include "shallow_sand/scene/scene.h"

namespace shallow_sand {

/// All private parameters of sand_node.
struct NodeParameters {
  Scene scene;                                          ///< from the keys of a scene file
  std::string robot_description = "robot_description";  ///< name of the parameter with the URDF
  std::string tf_prefix;                                ///< put before link names to get their tf frames
  double frame_rate = 50.0;   ///< at which poses are taken and the sand runs on [Hz]
  double publish_rate = 5.0;  ///< of ~points and ~mesh [Hz]
  double tf_timeout = 1.0;    ///< older poses are stale [s]
  std::string report;         ///< file for the figures at the end; empty: none
  std::string picture;        ///< file for a shaded relief at the end; empty: none
};

/// Reads and checks the private parameters. @throws SceneError naming the parameter
NodeParameters readNodeParameters(const ros::NodeHandle& private_node);

}  // namespace shallow_sand
