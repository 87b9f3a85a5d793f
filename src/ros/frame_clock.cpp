#include "shallow_sand/ros/frame_clock.h"

#include <algorithm>
#include <cmath>

namespace shallow_sand {
namespace {

/// [s]
constexpr double kLongestFrame = 0.1;

/// Of a frame [ns].
std::int64_t frameOf(double rate) {
  const double parts = std::max(1.0, std::ceil(1.0 / (rate * kLongestFrame) - 1e-9));
  return std::llround(1e9 / (rate * parts));
}

}  // namespace

FrameClock::FrameClock(double rate) : nanoseconds_(frameOf(rate)) {}

void FrameClock::setRate(double rate) {
  const std::int64_t nanoseconds = frameOf(rate);
  if (nanoseconds == nanoseconds_) return;
  const double given_up = givenUp();
  const std::int64_t before = nanoseconds_;
  nanoseconds_ = nanoseconds;
  lost_ = 0;
  given_up_before_ = given_up;
  if (!taken_) return;
  const auto firstAtOrAfter = [&](std::int64_t index) { return (index * before - 1) / nanoseconds + 1; };
  const std::int64_t end = *taken_ * before;
  taken_ = firstAtOrAfter(*taken_);
  asked_ = firstAtOrAfter(asked_);
  given_up_before_ += 1e-9 * static_cast<double>(*taken_ * nanoseconds - end);
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
