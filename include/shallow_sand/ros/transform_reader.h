#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>
#include <tf2/buffer_core.h>
#include <tf2_msgs/TFMessage.h>

#include <map>
#include <mutex>
#include <string>

namespace shallow_sand {

/// Reads /tf and /tf_static into a buffer, on a thread of its own. Unlike tf2_ros::TransformListener, which
/// logs each bad transform anew and says no more of it, this says it once and knows afterwards why a frame
/// has no pose; and when ROS time goes back, what still arrives from the time before is not taken in.
class TransformReader {
 public:
  TransformReader();

  const tf2::BufferCore& buffer() const { return buffer_; }
  /// A transform that does not come from tf, checked like those that do.
  void take(const geometry_msgs::TransformStamped& transform);
  /// To be called when ROS time went backwards: forgets all but static transforms.
  void restart();
  /// Why the last transform of a frame or of one of those it hangs on was refused; empty if none was.
  std::string refusal(const std::string& frame) const;

 private:
  struct Refusal {
    std::string problem;
    ros::WallTime told;
    bool holds;  ///< no good transform has come since
  };
  void read(const tf2_msgs::TFMessage& message, const std::string& authority, bool is_static);
  void refuse(const std::string& frame, const std::string& problem);

  ros::CallbackQueue queue_;
  ros::NodeHandle node_;
  tf2::BufferCore buffer_;
  mutable std::mutex mutex_;  ///< guards the next three
  std::map<std::string, Refusal> refusals_;
  ros::Time last_read_;
  ros::WallTime restarted_;
  ros::Subscriber tf_;
  ros::Subscriber tf_static_;
  ros::AsyncSpinner spinner_{1, &queue_};
};

}  // namespace shallow_sand
