#include "shallow_sand/ros/height_field_publisher.h"

#include <ros/console.h>
#include <ros/single_subscriber_publisher.h>
#include <std_msgs/Empty.h>

#include <boost/make_shared.hpp>
#include <utility>

namespace shallow_sand {
namespace {

/// Updates that wait for a slow subscriber: four times what may change at once. If more would have to, it
/// misses some, notices, and asks for a map.
constexpr std::uint32_t kMostWaiting = 1024;

/// Those who ask for a map within so long get one together [s].
constexpr double kBetweenAnswers = 0.25;

/// A map takes 20 bytes a cell, and ROS drops messages of a gigabyte.
constexpr std::size_t kMostCellsSent = 49000000;

}  // namespace

HeightFieldPublisher::HeightFieldPublisher(ros::NodeHandle node, const Grid& grid, const std::string& frame,
                                           const SandConstants& sand, double rate, bool with_speed)
    : difference_(grid, frame, sand, with_speed),
      follower_(grid, rate,
                [this](const FieldsChange& change, const ros::Time& stamp) { take(change, stamp); }) {
  if (!silence(grid).empty()) {
    ROS_WARN_STREAM(silence(grid));
    return;
  }
  node.setCallbackQueue(&follower_.queue());
  maps_ = node.advertise<HeightField>("height_field", 1, [this](const ros::SingleSubscriberPublisher& one) {
    follower_.wake();
    if (difference_.hasMap()) one.publish(difference_.map());
  });
  // Where the map was remapped to, the rest goes with it.
  updates_ = node.advertise<HeightFieldUpdate>(maps_.getTopic() + "_updates", kMostWaiting,
                                               [this](const ros::SingleSubscriberPublisher& one) {
                                                 follower_.wake();
                                                 if (difference_.hasMap())
                                                   one.publish(difference_.sequence());
                                               });
  requests_ = node.subscribe<std_msgs::Empty>(maps_.getTopic() + "_requests", 1,
                                              [this](const std_msgs::EmptyConstPtr&) { answerRequest(); });
  follower_.start();
}

std::string HeightFieldPublisher::silence(const Grid& grid) {
  if (grid.cells() <= kMostCellsSent) return "";
  return "~height_field stays silent: " + std::to_string(grid.cells()) + " cells are more than " +
         std::to_string(kMostCellsSent) + ", which a message can hold";
}

void HeightFieldPublisher::answerRequest() {
  const ros::WallTime now = ros::WallTime::now();
  if (!difference_.hasMap() || now - answered_ < ros::WallDuration(kBetweenAnswers)) return;
  answered_ = now;
  maps_.publish(difference_.map());
}

void HeightFieldPublisher::take(const FieldsChange& change, const ros::Time& stamp) {
  HeightFieldDifference::News news = difference_.take(change, stamp);
  if (news.map_is_new) maps_.publish(difference_.map());
  for (HeightFieldUpdate& update : news.updates)
    updates_.publish(boost::make_shared<const HeightFieldUpdate>(std::move(update)));
}

}  // namespace shallow_sand
