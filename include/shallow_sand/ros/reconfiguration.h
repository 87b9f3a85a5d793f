#pragma once

#include <dynamic_reconfigure/server.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>

#include <atomic>
#include <functional>

#include "shallow_sand/SandConfig.h"
#include "shallow_sand/ros/node_parameters.h"
#include "shallow_sand/sim/simulator.h"

namespace shallow_sand {

/// dynamic_reconfigure under ~reconfigure: material, gravity and some of the node's parameters while the sand
/// runs. It starts with the values that there are. A request is taken as a whole or not at all: where
/// something is refused, all of it goes back to what it was, with one warning line. What lies beyond bounds
/// dynamic_reconfigure itself puts at the bound before it is seen here. The server has a thread of its own,
/// for it talks to the parameter server for every request; the changes are made in the sand's thread.
class Reconfiguration {
 public:
  /// @param node whose name ~reconfigure follows; what is asked for is done from its callback queue
  /// @param parameters are changed, and the simulator is; both must outlive this
  /// @param changed is called after something of `parameters` has
  Reconfiguration(const ros::NodeHandle& node, NodeParameters& parameters, Simulator& simulator,
                  std::function<void()> changed);
  ~Reconfiguration();

 private:
  /// In the server's thread: passes the request on, and waits for the answer.
  void ask(SandConfig& wanted);
  /// In the sand's thread. Returns what holds afterwards.
  SandConfig take(const SandConfig& wanted);
  void apply(const SandConfig& wanted);

  NodeParameters& parameters_;
  Simulator& simulator_;
  std::function<void()> changed_;
  ros::CallbackQueueInterface& sand_queue_;
  SandConfig taken_;  ///< the last that was not refused
  ros::CallbackQueue queue_;
  std::atomic<bool> asking_{false};  ///< the sand's thread serves requests
  boost::recursive_mutex mutex_;
  dynamic_reconfigure::Server<SandConfig> server_;
  ros::AsyncSpinner spinner_{1, &queue_};
};

/// How it starts.
SandConfig startingConfig(const NodeParameters& parameters, const SimulatorParameters& sand);

}  // namespace shallow_sand
