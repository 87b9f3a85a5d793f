#pragma once

#include <dynamic_reconfigure/server.h>
#include <ros/node_handle.h>

#include <functional>

#include "shallow_sand/SandConfig.h"
#include "shallow_sand/ros/node_parameters.h"
#include "shallow_sand/sim/simulator.h"

namespace shallow_sand {

/// dynamic_reconfigure under ~reconfigure: material, gravity and some of the node's parameters while the sand
/// runs. It starts with the values that there are. A request is taken as a whole or not at all: where
/// something is refused, all of it goes back to what it was, with one warning line. What lies beyond bounds
/// dynamic_reconfigure itself puts at the bound before it is seen here.
class Reconfiguration {
 public:
  /// @param node whose name ~reconfigure follows
  /// @param parameters are changed, and the simulator is; both must outlive this
  /// @param changed is called after something of `parameters` has
  Reconfiguration(const ros::NodeHandle& node, NodeParameters& parameters, Simulator& simulator,
                  std::function<void()> changed);

 private:
  void take(SandConfig& wanted);
  void apply(const SandConfig& wanted);

  NodeParameters& parameters_;
  Simulator& simulator_;
  std::function<void()> changed_;
  SandConfig taken_;  ///< the last that was not refused
  boost::recursive_mutex mutex_;
  dynamic_reconfigure::Server<SandConfig> server_;
};

/// How it starts.
SandConfig startingConfig(const NodeParameters& parameters, const SimulatorParameters& sand);

}  // namespace shallow_sand
