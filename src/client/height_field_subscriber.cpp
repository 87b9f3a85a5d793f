#include "shallow_sand/client/height_field_subscriber.h"

#include <ros/console.h>
#include <std_msgs/Empty.h>

namespace shallow_sand {

namespace {

/// As often it is looked whether a map is needed [s]; so long it may be on its way.
constexpr double kPatience = 0.5;

}  // namespace

HeightFieldSubscriber::HeightFieldSubscriber(const ros::NodeHandle& node, const std::string& topic,
                                             Callback changed)
    : node_(node), topic_(node_.resolveName(topic)), changed_(std::move(changed)) {
  maps_ = node_.subscribe<HeightField>(topic, 1, [this](const HeightField::ConstPtr& map) { take(*map); });
  // Where the map was remapped to, the rest goes with it. A frame of the node may be many updates.
  updates_ = node_.subscribe<HeightFieldUpdate>(
      topic_ + "_updates", 4096, [this](const HeightFieldUpdate::ConstPtr& update) { take(*update); });
  requests_ = node_.advertise<std_msgs::Empty>(topic_ + "_requests", 1);
  timer_ = node_.createWallTimer(ros::WallDuration(kPatience),
                                 [this](const ros::WallTimerEvent&) { askForMap(); });
}

template <class Message>
void HeightFieldSubscriber::take(const Message& message) {
  const HeightFieldMap::Change change = map_.take(message);
  if (!change.refused.empty()) ROS_ERROR_STREAM_THROTTLE(10.0, topic_ << ": " << change.refused);
  if (change.made_anew || !change.cells.empty()) changed_(*map_.field(), change);
}

void HeightFieldSubscriber::askForMap() {
  const bool needs_map = map_.needsMap() || map_.field() == nullptr;
  if (needs_map && needed_map_) requests_.publish(std_msgs::Empty());
  needed_map_ = needs_map;
}

}  // namespace shallow_sand
