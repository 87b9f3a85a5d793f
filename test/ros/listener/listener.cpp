#include <nodelet/nodelet.h>
#include <ros/ros.h>
#include <sensor_msgs/PointCloud2.h>
#include <std_msgs/UInt64.h>

#include <boost/make_shared.hpp>
#include <cstdint>
#include <pluginlib/class_list_macros.hpp>

namespace shallow_sand {

/// Publishes on ~address where in memory the last cloud on ~points is; 0 if ROS has read it anew from bytes.
class Listener : public nodelet::Nodelet {
  using Cloud = sensor_msgs::PointCloud2;

  void onInit() override {
    ros::NodeHandle& node = getPrivateNodeHandle();
    address_ = node.advertise<std_msgs::UInt64>("address", 1, true);
    ros::SubscribeOptions options;
    options.init<Cloud>(
        "points", 1, [this](const Cloud::ConstPtr& cloud) { take(cloud); },
        [this] { return read_ = boost::make_shared<Cloud>(); });
    points_ = node.subscribe(options);
  }

  void take(const Cloud::ConstPtr& cloud) {
    std_msgs::UInt64 address;
    if (cloud != read_) address.data = reinterpret_cast<std::uintptr_t>(cloud.get());
    address_.publish(address);
  }

  Cloud::Ptr read_;
  ros::Publisher address_;
  ros::Subscriber points_;
};

}  // namespace shallow_sand

PLUGINLIB_EXPORT_CLASS(shallow_sand::Listener, nodelet::Nodelet)
