#pragma once

#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <ros/wall_timer.h>

#include <functional>
#include <string>

#include "shallow_sand/client/height_field_map.h"

namespace shallow_sand {

/// Follows the sand of a node: subscribes to its height field and the updates of that, and asks for the whole
/// map again when updates were lost. Callbacks come from the queue of the node handle. All that follow one
/// topic in a process get its map anew when one of them asks; other subscribers to it in the same process
/// must not be, for they would keep the connection, and the map comes with a new one.
class HeightFieldSubscriber {
 public:
  using Callback = std::function<void(const HeightField&, const HeightFieldMap::Change&)>;

  /// @param topic of the HeightField, such as /sand_node/height_field; updates come on topic + "_updates"
  /// @param changed is called after each message that changed the map
  HeightFieldSubscriber(const ros::NodeHandle& node, const std::string& topic, Callback changed);
  ~HeightFieldSubscriber();
  HeightFieldSubscriber(const HeightFieldSubscriber&) = delete;
  HeightFieldSubscriber& operator=(const HeightFieldSubscriber&) = delete;

  const HeightField* field() const { return map_.field(); }
  std::string topic() const { return node_.resolveName(topic_); }

 private:
  template <class Message>
  void take(const Message& message);
  void askForMap();
  void subscribeToMaps();
  void heal();

  ros::NodeHandle node_;
  std::string topic_;
  Callback changed_;
  HeightFieldMap map_;
  bool needed_map_ = false;  // when it was looked the last time
  ros::Subscriber maps_;     // changed with the lock of all followers only
  ros::Subscriber updates_;
  ros::WallTimer timer_;
};

}  // namespace shallow_sand
