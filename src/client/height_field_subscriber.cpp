#include "shallow_sand/client/height_field_subscriber.h"

#include <ros/console.h>

#include <algorithm>
#include <mutex>

namespace shallow_sand {

namespace {

/// As often it is looked whether updates wait for a map [s]; so long a map may be on its way.
constexpr double kPatience = 0.5;

/// Those of this process.
struct Followers {
  std::mutex mutex;
  std::vector<HeightFieldSubscriber*> all;
};
Followers& followers() {
  static Followers followers;
  return followers;
}

}  // namespace

HeightFieldSubscriber::HeightFieldSubscriber(const ros::NodeHandle& node, const std::string& topic,
                                             Callback changed)
    : node_(node), topic_(topic), changed_(std::move(changed)) {
  {
    const std::lock_guard<std::mutex> lock(followers().mutex);
    followers().all.push_back(this);
  }
  askForMap();
  // A frame of the node may be many updates.
  updates_ = node_.subscribe<HeightFieldUpdate>(
      topic_ + "_updates", 4096, [this](const HeightFieldUpdate::ConstPtr& update) { take(*update); });
  timer_ =
      node_.createWallTimer(ros::WallDuration(kPatience), [this](const ros::WallTimerEvent&) { heal(); });
}

HeightFieldSubscriber::~HeightFieldSubscriber() {
  const std::lock_guard<std::mutex> lock(followers().mutex);
  auto& all = followers().all;
  all.erase(std::remove(all.begin(), all.end(), this), all.end());
}

/// The node sends the map to each connection that is new, and ROS has one for all subscribers of a process.
void HeightFieldSubscriber::askForMap() {
  const std::lock_guard<std::mutex> lock(followers().mutex);
  std::vector<HeightFieldSubscriber*> here;
  for (HeightFieldSubscriber* follower : followers().all) {
    if (follower->topic() == topic()) here.push_back(follower);
  }
  for (HeightFieldSubscriber* follower : here) follower->maps_.shutdown();
  for (HeightFieldSubscriber* follower : here) follower->subscribeToMaps();
}

void HeightFieldSubscriber::subscribeToMaps() {
  maps_ = node_.subscribe<HeightField>(topic_, 1, [this](const HeightField::ConstPtr& map) { take(*map); });
}

template <class Message>
void HeightFieldSubscriber::take(const Message& message) {
  const HeightFieldMap::Change change = map_.take(message);
  if (!change.refused.empty()) ROS_ERROR_STREAM_THROTTLE(10.0, topic_ << ": " << change.refused);
  if (change.made_anew || !change.cells.empty()) changed_(*map_.field(), change);
}

void HeightFieldSubscriber::heal() {
  const bool needs_map = map_.needsMap();
  if (needs_map && needed_map_) askForMap();
  // Once asked for, the map has as long again to come.
  needed_map_ = needs_map && !needed_map_;
}

}  // namespace shallow_sand
