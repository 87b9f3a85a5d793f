// follow_height_field TOPIC [LOSE]: follows a height field in a process of its own, twice; the second time
// from a little later on. Whoever subscribes to ~copy or ~second_copy gets that copy as it is then. With LOSE
// it gets all through a relay that loses every LOSE-th update, but, as queues do, never the last one. At its
// end it prints how late updates came [s].
#include <ros/ros.h>
#include <ros/single_subscriber_publisher.h>
#include <std_msgs/Empty.h>

#include <algorithm>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "shallow_sand/client/height_field_subscriber.h"

namespace shallow_sand {
namespace {

/// Passes a height field on, with losses.
class LossyRelay {
 public:
  LossyRelay(const std::string& from, const std::string& to, int lose) : lose_(lose) {
    maps_out_ = node_.advertise<HeightField>(to, 1);
    requests_out_ = node_.advertise<std_msgs::Empty>(from + "_requests", 1);
    maps_ = node_.subscribe<HeightField>(
        from, 1, [this](const HeightField::ConstPtr& map) { maps_out_.publish(map); });
    requests_ = node_.subscribe<std_msgs::Empty>(
        to + "_requests", 1,
        [this](const std_msgs::EmptyConstPtr& request) { requests_out_.publish(request); });
    updates_out_ = node_.advertise<HeightFieldUpdate>(to + "_updates", 4096);
    updates_ = node_.subscribe<HeightFieldUpdate>(
        from + "_updates", 4096, [this](const HeightFieldUpdate::ConstPtr& update) { take(update); });
    timer_ = node_.createWallTimer(ros::WallDuration(0.05), [this](const ros::WallTimerEvent&) { flush(); });
  }

 private:
  void take(const HeightFieldUpdate::ConstPtr& update) {
    if (held_ && ++count_ % lose_ != 0) updates_out_.publish(held_);
    held_ = update;
    held_since_ = ros::WallTime::now();
  }
  void flush() {
    if (!held_ || (ros::WallTime::now() - held_since_).toSec() < 0.3) return;
    updates_out_.publish(held_);
    held_.reset();
  }

  ros::NodeHandle node_;
  int lose_;
  int count_ = 0;
  HeightFieldUpdate::ConstPtr held_;
  ros::WallTime held_since_;
  ros::Publisher maps_out_;
  ros::Publisher updates_out_;
  ros::Publisher requests_out_;
  ros::Subscriber maps_;
  ros::Subscriber updates_;
  ros::Subscriber requests_;
  ros::WallTimer timer_;
};

/// @param duration from the first to the last [s]
void report(std::vector<double> delays, std::size_t updates, double duration) {
  std::sort(delays.begin(), delays.end());
  if (delays.empty()) return;
  std::cout << "{\"updates\": " << updates << ", \"instants\": " << delays.size()
            << ", \"median\": " << delays[delays.size() / 2] << ", \"max\": " << delays.back()
            << ", \"duration\": " << duration << "}" << std::endl;
}

void follow(const std::string& topic, int lose) {
  ros::NodeHandle node("~");
  std::unique_ptr<LossyRelay> relay;
  std::string source = topic;
  if (lose > 0) {
    source = node.resolveName("relayed");
    relay = std::make_unique<LossyRelay>(topic, source, lose);
  }
  // Of the last update of each instant of the sand.
  std::vector<double> delays;
  std::size_t updates = 0;
  ros::Time first;
  ros::Time last;
  HeightFieldSubscriber follower(ros::NodeHandle(), source,
                                 [&](const HeightField& field, const HeightFieldMap::Change& change) {
                                   if (change.made_anew) return;
                                   ++updates;
                                   if (field.header.stamp != last || delays.empty()) delays.push_back(0.0);
                                   last = field.header.stamp;
                                   if (first.isZero()) first = last;
                                   delays.back() = (ros::Time::now() - last).toSec();
                                 });
  std::unique_ptr<HeightFieldSubscriber> second;
  const ros::WallTimer later = node.createWallTimer(
      ros::WallDuration(0.5),
      [&](const ros::WallTimerEvent&) {
        second = std::make_unique<HeightFieldSubscriber>(
            ros::NodeHandle(), source, [](const HeightField&, const HeightFieldMap::Change&) {});
      },
      true);
  const auto offer = [&node](const std::string& name, const auto& field) {
    return node.advertise<HeightField>(name, 1, [field](const ros::SingleSubscriberPublisher& one) {
      if (field() != nullptr) one.publish(*field());
    });
  };
  const ros::Publisher copy = offer("copy", [&follower] { return follower.field(); });
  const ros::Publisher second_copy =
      offer("second_copy", [&second] { return second ? second->field() : nullptr; });
  ros::spin();
  report(delays, updates, (last - first).toSec());
}

}  // namespace
}  // namespace shallow_sand

int main(int argument_count, char** arguments) {
  ros::init(argument_count, arguments, "follow_height_field");
  if (argument_count < 2) return 2;
  shallow_sand::follow(arguments[1], argument_count > 2 ? std::stoi(arguments[2]) : 0);
  return 0;
}
