#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/subscriber.h>
#include <ros/wall_timer.h>

#include <functional>
#include <string>

#include "shallow_sand/client/height_field_map.h"

namespace shallow_sand {

/// Follows the sand of a node: subscribes to its height field and the updates of that, and asks for the whole
/// map when none comes by itself (another subscriber of this process has had it) or updates were lost.
/// Callbacks come from the queue of the node handle; one thread may serve that, and none of them may destroy
/// this.
class HeightFieldSubscriber {
 public:
  using Callback = std::function<void(const HeightField&, const HeightFieldMap::Change&)>;

  /// @param topic of the HeightField, such as /sand_node/height_field; updates come on topic + "_updates",
  /// and the map is asked for on topic + "_requests"
  /// @param changed is called after each message that changed the map
  HeightFieldSubscriber(const ros::NodeHandle& node, const std::string& topic, Callback changed);
  HeightFieldSubscriber(const HeightFieldSubscriber&) = delete;
  HeightFieldSubscriber& operator=(const HeightFieldSubscriber&) = delete;

  const HeightField* field() const { return map_.field(); }

 private:
  template <class Message>
  void take(const Message& message);
  void askForMap();

  ros::NodeHandle node_;
  std::string topic_;
  Callback changed_;
  HeightFieldMap map_;
  bool needed_map_ = false;  // when it was looked the last time
  ros::Subscriber maps_;
  ros::Subscriber updates_;
  ros::Publisher requests_;
  ros::WallTimer timer_;
};

}  // namespace shallow_sand
