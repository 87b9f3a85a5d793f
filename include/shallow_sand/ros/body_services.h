#pragma once

#include <ros/node_handle.h>

#include "shallow_sand/AddBody.h"
#include "shallow_sand/MoveBody.h"
#include "shallow_sand/RemoveBody.h"
#include "shallow_sand/ros/sand_bodies.h"

namespace shallow_sand {

/// The services ~add_body, ~remove_body and ~move_body. The distance field of a body is computed before
/// ~add_body answers, and the sand waits that long.
class BodyServices {
 public:
  /// @param bodies must outlive this
  BodyServices(ros::NodeHandle& private_node, const std::string& sand_frame, double sand_spacing,
               SandBodies& bodies);

 private:
  bool add(AddBody::Request& request, AddBody::Response& response);
  bool remove(RemoveBody::Request& request, RemoveBody::Response& response);
  bool move(MoveBody::Request& request, MoveBody::Response& response);
  /// Of a frame in the sand's; the identity if it has no name. @throws tf2::TransformException
  Eigen::Isometry3d poseOf(const std::string& frame) const;

  std::string sand_frame_;
  double sand_spacing_;
  SandBodies& bodies_;
  ros::ServiceServer add_;
  ros::ServiceServer remove_;
  ros::ServiceServer move_;
};

}  // namespace shallow_sand
