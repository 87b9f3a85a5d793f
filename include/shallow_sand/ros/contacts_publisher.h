#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <string>
#include <vector>

#include "shallow_sand/sim/simulator.h"

namespace shallow_sand {

/// Publishes ~contacts while somebody listens.
class ContactsPublisher {
 public:
  /// @param node whose name the topic begins with
  /// @param start depth of the sand from which on digging counts [m]; must outlive this
  /// @param rate at most so often, of the wall clock [Hz]
  ContactsPublisher(ros::NodeHandle node, const std::vector<float>& start, const std::string& frame,
                    double rate);

  /// From now on at most so often [Hz].
  void setRate(double rate) { period_ = ros::WallDuration(1.0 / rate); }
  /// Whether figures are wanted now.
  bool isDue() const;
  void send(const Simulator& simulator, const ros::Time& stamp);

 private:
  const std::vector<float>& start_;
  std::string frame_;
  ros::WallDuration period_;
  ros::WallTime next_;
  ros::Publisher contacts_;
};

}  // namespace shallow_sand
