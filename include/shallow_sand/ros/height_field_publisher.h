#pragma once

#include <ros/node_handle.h>

#include <string>

#include "shallow_sand/ros/fields_follower.h"
#include "shallow_sand/ros/height_field_difference.h"

namespace shallow_sand {

/// Publishes ~height_field and ~height_field_updates:
/// - whoever subscribes to ~height_field gets the whole map as it is then; nobody else does. A latch would
///   hold a map that is old, and sending it with each change would be what the updates are there to avoid;
/// - whoever subscribes to ~height_field_updates gets an empty update at once, and knows from its sequence
///   whether one was missed;
/// - whoever publishes on ~height_field_requests makes that everybody gets the whole map: after updates were
///   lost, or in a process that has a connection already, over which none came;
/// - then come the rectangles that have changed, at most at a rate, and nothing while nothing changes;
/// - a bed that is another is a new map, which everybody gets.
/// As long as nobody has listened, nothing is done.
class HeightFieldPublisher {
 public:
  /// @param node whose name the topics begin with @param rate of updates [Hz]
  HeightFieldPublisher(ros::NodeHandle node, const Grid& grid, const std::string& frame,
                       const SandConstants& sand, double rate, bool with_speed);
  ~HeightFieldPublisher() { follower_.stop(); }

  /// Why it stays silent on such a map; empty if it does not.
  static std::string silence(const Grid& grid);
  /// What the sand's thread hands fields to.
  FieldsFollower& follower() { return follower_; }

 private:
  void take(const FieldsChange& change, const ros::Time& stamp);
  void answerRequest();

  HeightFieldDifference difference_;  ///< of the follower's thread, as all that follows
  FieldsFollower follower_;
  ros::Publisher maps_;
  ros::Publisher updates_;
  ros::Subscriber requests_;
  ros::WallTime answered_;
};

}  // namespace shallow_sand
