#include <nodelet/nodelet.h>

#include <atomic>
#include <pluginlib/class_list_macros.hpp>
#include <thread>

#include "shallow_sand/ros/sand_node.h"

namespace shallow_sand {

/// SandNode in a manager of nodelets, on a thread of its own. What ends the node as a program leaves the
/// manager running, with a fatal line.
class SandNodelet : public nodelet::Nodelet {
 public:
  ~SandNodelet() override {
    stopping_ = true;
    if (thread_.joinable()) thread_.join();
  }

 private:
  void onInit() override {
    thread_ = std::thread([this] { run(); });
  }

  void run() {
    try {
      SandNode(getNodeHandle(), getPrivateNodeHandle()).run([this] { return !stopping_; });
    } catch (const std::exception& error) {
      NODELET_FATAL_STREAM(error.what());
    }
  }

  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

}  // namespace shallow_sand

PLUGINLIB_EXPORT_CLASS(shallow_sand::SandNodelet, nodelet::Nodelet)
