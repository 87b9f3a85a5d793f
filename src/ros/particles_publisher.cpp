#include "shallow_sand/ros/particles_publisher.h"

#include <algorithm>
#include <boost/make_shared.hpp>
#include <memory>
#include <utility>

#include "shallow_sand/ros/conversions.h"
#include "shallow_sand/ros/queued_call.h"

namespace shallow_sand {

ParticlesPublisher::ParticlesPublisher(ros::NodeHandle node, const Grid& grid, const std::string& frame,
                                       double rate)
    : grid_(grid), frame_(frame), period_(1.0 / rate) {
  particles_ = node.advertise<sensor_msgs::PointCloud2>("particles", 1);
  spinner_.start();
}

void ParticlesPublisher::setRate(double rate) {
  period_ = ros::WallDuration(1.0 / rate);
  // What was to come after a long period comes after this one.
  next_ = std::min(next_, ros::WallTime::now() + period_);
}

bool ParticlesPublisher::isDue() const {
  return !busy_ && particles_.getNumSubscribers() > 0 && ros::WallTime::now() >= next_;
}

void ParticlesPublisher::send(Grains grains, Fields fields, const ros::Time& stamp) {
  next_ = ros::WallTime::now() + period_;
  busy_ = true;
  const auto sand = std::make_shared<const std::pair<Grains, Fields>>(std::move(grains), std::move(fields));
  queue_.addCallback(boost::make_shared<QueuedCall>([this, sand, stamp] {
    const auto& [grains, fields] = *sand;
    particles_.publish(boost::make_shared<const sensor_msgs::PointCloud2>(
        toPointCloud(grid_, fields, grainCloud(grid_, fields, grains), frame_, stamp)));
    busy_ = false;
  }));
}

}  // namespace shallow_sand
