#include "shallow_sand/ros/service_thread.h"

#include <ros/console.h>

namespace shallow_sand {

ServiceThread::ServiceThread(const ros::NodeHandle& node, LoopCalls& loop) : loop_(loop), node_(node) {
  node_.setCallbackQueue(&queue_);
}

ServiceThread::~ServiceThread() {
  // The node's loop has ended: who waits for it would hold up the end of the thread.
  loop_.close();
}

void ServiceThread::Refusals::tell(const std::string& problem) {
  constexpr double kTellAgain = 5.0;
  const ros::WallTime now = ros::WallTime::now();
  if (!told_.isZero() && (now - told_).toSec() < kTellAgain) return;
  told_ = now;
  ROS_WARN_STREAM("~" << service_ << " is refused: " << problem);
}

}  // namespace shallow_sand
