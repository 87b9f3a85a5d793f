#pragma once

#include <ros/time.h>

#include <cstdint>
#include <optional>

namespace shallow_sand {

/// Cuts ROS time into frames, always at the same instants (whole multiples of a frame's length since time 0),
/// however often and unevenly the node asks: so the same bag gives the same frames, and the same bits.
class FrameClock {
 public:
  /// Of ROS time that may be caught up [s]; what lies further back is given up, so that a slow machine stays
  /// responsive. Where the clock leaps by more, all but the last frame is.
  static constexpr double kMostBehind = 0.5;

  /// @param rate frames a second, above 0; below 10 they are cut so that none is longer than 0.1 s
  explicit FrameClock(double rate);
  /// From now on frames have this rate, and lie at whole multiples of their new length. What lies between the
  /// last one that was taken and the next such instant is given up.
  void setRate(double rate);

  /// Of a frame [s]; a multiple of 2^-30, so that sums of them are exact. ROS time counts nanoseconds, so the
  /// two differ by up to half of one.
  double length() const;

  /// Frames that end by `now` and were not taken yet; 0 when asked first, for sand starts from there.
  /// @param now not before the last one, unless restart() was called
  std::int64_t due(const ros::Time& now);
  /// Takes the next frame, due or not, and returns when it ends.
  ros::Time next();
  /// The last frame that was taken is the one before `now`; nothing was given up.
  void skipTo(const ros::Time& now);
  /// The clock starts anew.
  void restart() { taken_.reset(); }

  bool hasStarted() const { return taken_.has_value(); }
  /// End of the last frame that was taken; must have started.
  ros::Time end() const { return endOf(*taken_); }
  /// What was given up since the construction [s].
  double givenUp() const { return given_up_before_ + static_cast<double>(lost_) * length(); }

 private:
  std::int64_t indexAt(const ros::Time& now) const;
  ros::Time endOf(std::int64_t index) const;

  std::int64_t nanoseconds_;           ///< of a frame
  std::optional<std::int64_t> taken_;  ///< the last frame; frame k ends at k times its length
  std::int64_t asked_ = 0;             ///< the last frame that was due when last asked
  std::int64_t lost_ = 0;              ///< frames
  double given_up_before_ = 0.0;       ///< since when frames have been as long as they are [s]
};

}  // namespace shallow_sand
