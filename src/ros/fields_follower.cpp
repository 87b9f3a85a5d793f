#include "shallow_sand/ros/fields_follower.h"

#include <algorithm>
#include <boost/make_shared.hpp>
#include <utility>

#include "shallow_sand/ros/queued_call.h"

namespace shallow_sand {
FieldsFollower::FieldsFollower(const Grid& grid, double rate, Take take)
    : grid_(grid), period_(1.0 / rate), take_(std::move(take)), changed_(grid, 32, 8) {
  changed_.add(Window::all(grid));
}

void FieldsFollower::setRate(double rate) {
  period_ = ros::WallDuration(1.0 / rate);
  // What was to come after a long period comes after this one.
  next_ = std::min(next_, ros::WallTime::now() + period_);
}

bool FieldsFollower::isDue() const { return awake_ && !busy_ && ros::WallTime::now() >= next_; }

void FieldsFollower::note(const std::vector<Window>& changes) {
  for (const Window& window : changes) changed_.add(window);
}

void FieldsFollower::send(const Fields& fields, const ros::Time& stamp) {
  // Frames come when they come: what is late does not make the next one late.
  next_ = std::max(next_ + period_, ros::WallTime::now());
  change_ = changeOf(fields, changed_.take(), grid_, std::move(change_));
  busy_ = true;
  queue_.addCallback(boost::make_shared<QueuedCall>([this, stamp] {
    take_(change_, stamp);
    busy_ = false;
  }));
}

}  // namespace shallow_sand
