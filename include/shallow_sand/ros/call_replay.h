#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>

#include <future>
#include <map>
#include <string>

#include "shallow_sand/ServiceCall.h"
#include "shallow_sand/ros/call_record.h"

namespace shallow_sand {

/// Carries out calls that another node has published on ~calls, and a bag plays: each between the same two
/// frames as there. What takes long is computed beside the sand, from when a call comes; the sand waits for
/// it when it is due. What is late is carried out at once, and what cannot be carried out is left; one line
/// of the log tells of it, at most every five seconds.
class CallReplay {
 public:
  /// @param node from whose callback queue messages are taken
  /// @param topic empty: there is none
  /// @param calls knows all kinds of them; it, the clock and what its kinds need must outlive this
  /// @throws InvalidParameter if it is no name of a topic, or the one of `calls`
  CallReplay(ros::NodeHandle node, const std::string& topic, const CallRecord& calls,
             const FrameClock& clock);
  ~CallReplay();

  /// To be called by the loop before each frame: what is due at the end of the last one.
  void carryOutDue();
  /// To be called when ROS time went back to `now`: calls of later times are forgotten.
  void restart(const ros::Time& now);

 private:
  struct Call {
    std::string service;
    std::future<Change> change;
  };
  void take(const ServiceCall& message);
  void carryOut(const ros::Time& stamp, Call& call) const;

  const CallRecord& calls_;
  const FrameClock& clock_;
  std::multimap<ros::Time, Call> waiting_;  ///< of one time, in the order in which they came
  ros::Subscriber subscriber_;
  ros::CallbackQueue preparing_;
  ros::AsyncSpinner spinner_{1, &preparing_};
};

}  // namespace shallow_sand
