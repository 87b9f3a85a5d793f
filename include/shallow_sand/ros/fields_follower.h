#pragma once

#include <ros/callback_queue.h>
#include <ros/spinner.h>
#include <ros/time.h>

#include <atomic>
#include <functional>
#include <vector>

#include "shallow_sand/device/tile_set.h"
#include "shallow_sand/ros/fields_change.h"

namespace shallow_sand {

/// A thread that follows the sand at a rate of its own. The sand's thread hands over what has changed, and
/// only when the one before is done with: it never waits, and nothing piles up.
class FieldsFollower {
 public:
  using Take = std::function<void(const FieldsChange&, const ros::Time&)>;

  /// @param rate at most so often, of the wall clock: the sand's may stand still while somebody pours [Hz]
  /// @param take is called in the follower's thread; the first change is whole
  FieldsFollower(const Grid& grid, double rate, Take take);

  /// Of the follower's thread: whatever is called from it needs no locks.
  ros::CallbackQueue& queue() { return queue_; }
  void start() { spinner_.start(); }
  /// Waits for what is under way. To be called before what `take` uses is gone.
  void stop() { spinner_.stop(); }
  /// From now on fields are wanted. From any thread.
  void wake() { awake_ = true; }

  /// The rest is for the sand's thread. From now on. [Hz]
  void setRate(double rate);
  /// Whether fields are wanted now.
  bool isDue() const;
  /// Fields have changed in these windows.
  void note(const std::vector<Window>& changes);
  /// Hands over all that has changed since the last time.
  void send(const Fields& fields, const ros::Time& stamp);

 private:
  Grid grid_;
  ros::WallDuration period_;
  Take take_;
  TileSet changed_;
  ros::WallTime next_;
  FieldsChange change_;  ///< the follower's as long as it is busy, else the sand's
  std::atomic<bool> awake_{false};
  std::atomic<bool> busy_{false};
  ros::CallbackQueue queue_;
  ros::AsyncSpinner spinner_{1, &queue_};
};

}  // namespace shallow_sand
