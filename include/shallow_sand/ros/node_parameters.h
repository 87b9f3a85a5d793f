#pragma once

#include <ros/node_handle.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <string>
#include <vector>

#include "shallow_sand/bodies/link_selection.h"
#include "shallow_sand/ros/link_shapes.h"
#include "shallow_sand/scene/scene.h"

namespace shallow_sand {

/// A robot whose links dig. An element of ~robots, or ~robot_description and its company.
struct RobotParameters {
  std::string description = "robot_description";  ///< name of the parameter with the URDF
  std::string name;       ///< in ~status and the log; empty: tf_prefix without its slash, else the URDF's
  std::string tf_prefix;  ///< put before link names to get their tf frames
  LinkPatterns links;     ///< which of them
  LinkShapes shapes;      ///< and what stands for them
};

/// All private parameters of sand_node; parameterTable has their bounds.
struct NodeParameters {
  Scene scene;                          ///< from the keys of a scene file
  std::vector<RobotParameters> robots;  ///< none if ~robot_description is empty
  double frame_rate = 50.0;             ///< at which poses are taken and the sand runs on [Hz]
  bool paused = false;                  ///< at the start
  double publish_rate = 5.0;            ///< of ~points, ~mesh and ~bodies, of the wall clock [Hz]
  double height_field_rate = 10.0;      ///< of ~height_field_updates, of the wall clock [Hz]
  bool publish_speed = true;            ///< in ~height_field and its updates
  double tf_delay = 0.1;         ///< of the sand behind ROS time, so that the poses it needs have come [s]
  double tf_timeout = 1.0;       ///< older poses are stale [s]
  double max_body_speed = 10.0;  ///< of a body's farthest point; what is faster is a jump [m/s]
  double mesh_cells = 1e6;       ///< most cells that ~mesh shows; a larger map is shown by blocks of cells
  double pour_rate = 0.0;        ///< of sand that is poured all the time; below 0: taken away [m³/s]
  double pour_x = 0.0;           ///< where: the middle of a disc in the sand's frame [m]
  double pour_y = 0.0;           ///< [m]
  double pour_radius = 0.1;      ///< [m]
  std::string sand_frame;        ///< instead of the scene's grid.frame, unless empty
  std::string scene_folder;      ///< that paths in the scene start from; empty: they must be absolute
  std::string state_folder;      ///< of ~save and ~load; absolute
  double snapshot_period = 0.0;  ///< of simulated time after which the state is saved; 0: never [s]
  std::string snapshot_file = "latest.tif";  ///< within the folder
  bool restore = false;                      ///< go on from that file at the start, if it is there
  std::string replay_calls;                  ///< topic of calls that a bag plays; empty: none
  std::string report;                        ///< file for the figures at the end; empty: none
  std::string picture;                       ///< file for a shaded relief at the end; empty: none
  std::string mesh_file;                     ///< .stl or .ply for the surface at the end; empty: none
};

/// Reads and checks the private parameters. @throws SceneError naming the parameter
NodeParameters readNodeParameters(const ros::NodeHandle& private_node);
/// The same for parameters that came from the server.
/// @param all no parameters unless it is a map; not changed @param source names them in errors
NodeParameters readNodeParameters(XmlRpc::XmlRpcValue& all, const std::string& source);

}  // namespace shallow_sand
