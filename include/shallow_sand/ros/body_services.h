#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>

#include <functional>
#include <future>
#include <mutex>
#include <string>

#include "shallow_sand/AddBody.h"
#include "shallow_sand/MoveBody.h"
#include "shallow_sand/RemoveBody.h"
#include "shallow_sand/ros/sand_bodies.h"

namespace shallow_sand {

/// The services ~add_body, ~remove_body and ~move_body, on a thread of their own, so that the sand runs on
/// while a mesh is read and its distance field computed. What touches the bodies is handed to the node's
/// loop.
class BodyServices {
 public:
  /// @param node below which the services lie
  /// @param bodies must outlive this; used in `runPending` only
  BodyServices(ros::NodeHandle node, double sand_spacing, SandBodies& bodies);
  /// To be called by the node's loop: does what requests have handed over.
  void runPending();

 private:
  bool add(AddBody::Request& request, AddBody::Response& response);
  bool remove(RemoveBody::Request& request, RemoveBody::Response& response);
  bool move(MoveBody::Request& request, MoveBody::Response& response);
  /// Has the node's loop do something, and waits until it has. @throws what `action` throws
  void inLoop(const std::function<void()>& action);

  double sand_spacing_;
  SandBodies& bodies_;
  std::mutex mutex_;
  std::packaged_task<void()> pending_;  ///< guarded; at most one, for there is one thread of requests
  ros::CallbackQueue queue_;
  ros::ServiceServer add_;
  ros::ServiceServer remove_;
  ros::ServiceServer move_;
  ros::AsyncSpinner spinner_{1, &queue_};
};

}  // namespace shallow_sand
