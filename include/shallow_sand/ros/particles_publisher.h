#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/spinner.h>

#include <atomic>
#include <string>

#include "shallow_sand/core/fields.h"
#include "shallow_sand/particles/grains.h"

namespace shallow_sand {

/// Publishes ~particles, the grains that are seen, in a thread of its own, while somebody listens.
class ParticlesPublisher {
 public:
  /// @param node whose name the topic begins with @param rate at most so often, of the wall clock [Hz]
  ParticlesPublisher(ros::NodeHandle node, const Grid& grid, const std::string& frame, double rate);
  ~ParticlesPublisher() { spinner_.stop(); }

  /// The rest is for the sand's thread. From now on. [Hz]
  void setRate(double rate);
  /// Whether grains are wanted now.
  bool isDue() const;
  /// @param fields of the same time
  void send(Grains grains, Fields fields, const ros::Time& stamp);

 private:
  Grid grid_;
  std::string frame_;
  ros::WallDuration period_;
  ros::WallTime next_;
  std::atomic<bool> busy_{false};
  ros::Publisher particles_;
  ros::CallbackQueue queue_;
  ros::AsyncSpinner spinner_{1, &queue_};
};

}  // namespace shallow_sand
