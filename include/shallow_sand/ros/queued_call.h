#pragma once

#include <ros/callback_queue_interface.h>

#include <functional>
#include <utility>

namespace shallow_sand {

/// Any function, to be called from a queue of ROS.
class QueuedCall : public ros::CallbackInterface {
 public:
  explicit QueuedCall(std::function<void()> function) : function_(std::move(function)) {}
  CallResult call() override {
    function_();
    return Success;
  }

 private:
  std::function<void()> function_;
};

}  // namespace shallow_sand
