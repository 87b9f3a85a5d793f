#include "shallow_sand/ros/frame_clock.h"

#include <algorithm>
#include <cmath>

namespace shallow_sand {
namespace {

/// [s]
constexpr double kLongestFrame = 0.1;

}  // namespace

FrameClock::FrameClock(double rate) {
  const double parts = std::max(1.0, std::ceil(1.0 / (rate * kLongestFrame) - 1e-9));
  nanoseconds_ = std::llround(1e9 / (rate * parts));
}

double FrameClock::length() const {
  return std::ldexp(std::round(std::ldexp(1e-9 * static_cast<double>(nanoseconds_), 30)), -30);
}

std::int64_t FrameClock::due(const ros::Time& now) {
  const std::int64_t last = indexAt(now);
  if (!taken_) taken_ = asked_ = last;
  const auto most = static_cast<std::int64_t>(kMostBehind * 1e9) / nanoseconds_;
  const std::int64_t kept = last - asked_ > most ? 1 : most;
  asked_ = last;
  const std::int64_t too_many = std::max<std::int64_t>(0, last - *taken_ - kept);
  lost_ += too_many;
  *taken_ += too_many;
  return std::max<std::int64_t>(0, last - *taken_);
}

ros::Time FrameClock::next() {
  ++*taken_;
  return end();
}

void FrameClock::skipTo(const ros::Time& now) { taken_ = asked_ = indexAt(now); }

std::int64_t FrameClock::indexAt(const ros::Time& now) const {
  return static_cast<std::int64_t>(now.toNSec()) / nanoseconds_;
}

ros::Time FrameClock::endOf(std::int64_t index) const {
  return ros::Time().fromNSec(static_cast<std::uint64_t>(index * nanoseconds_));
}

}  // namespace shallow_sand
