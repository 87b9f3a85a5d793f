#pragma once

#include <functional>
#include <string>

#include "shallow_sand/AddBody.h"
#include "shallow_sand/MoveBody.h"
#include "shallow_sand/RemoveBody.h"
#include "shallow_sand/ros/pose_topics.h"
#include "shallow_sand/ros/sand_bodies.h"
#include "shallow_sand/ros/service_thread.h"

namespace shallow_sand {

/// The services ~add_body, ~remove_body and ~move_body: meshes are read and their distance fields computed
/// beside the sand.
class BodyServices {
 public:
  /// Loop, calls, bodies and transforms must outlive this; bodies are used in the loop only.
  BodyServices(const ros::NodeHandle& node, LoopCalls& loop, CallRecord& calls, const GridParameters& grid,
               SandBodies& bodies, TransformReader& transforms);

 private:
  /// What can be refused before its shape is sampled. @throws InvalidParameter, tf2::TransformException
  void checkAdding(const AddBody::Request& request) const;
  /// Samples its shape. @throws InvalidParameter
  Change adding(const AddBody::Request& request);
  Change removing(const RemoveBody::Request& request);
  Change moving(const MoveBody::Request& request);

  double sand_spacing_;
  SandBodies& bodies_;
  PoseTopics pose_topics_;
  ServiceThread services_;
};

}  // namespace shallow_sand
