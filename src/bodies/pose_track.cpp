#include "shallow_sand/bodies/pose_track.h"

#include <algorithm>
#include <cmath>

namespace shallow_sand {
namespace {

/// Times closer than this are the same: differences of times carry roundings. [s]
constexpr double kSameTime = 1e-6;

/// Within a longer frame the path is followed through several poses. [s]
constexpr double kKeySpacing = 0.02;

}  // namespace

double farthestMove(const Eigen::AlignedBox3d& box, const Eigen::Isometry3d& from,
                    const Eigen::Isometry3d& to) {
  double farthest = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d point = box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner));
    farthest = std::max(farthest, (to * point - from * point).norm());
  }
  return farthest;
}

Movement PoseTrack::follow(const FrameTimes& frame, double newest, const PoseSource& poseAt) {
  PoseTrack next = *this;
  Movement movement;
  next.enter(frame, newest, poseAt, movement);
  next.move(frame, newest, poseAt, movement);
  next.late_ = std::max(0.0, frame.end - newest);
  *this = next;
  return movement;
}

void PoseTrack::enter(const FrameTimes& frame, double newest, const PoseSource& poseAt, Movement& movement) {
  if (reached_ && reached_->time >= frame.start - kSameTime) return;
  const double time = std::min(frame.start, newest);
  if (reached_ && time <= reached_->time) return;
  const Place place{time, poseAt(time)};
  if (reached_) {
    movement.jump = jumpTo(place);
    movement.late = late_;
  }
  movement.placed = place.pose;
  reached_ = place;
  told_until_ = frame.start;
}

void PoseTrack::move(const FrameTimes& frame, double newest, const PoseSource& poseAt, Movement& movement) {
  const double from = std::max(reached_->time, frame.start);
  const double reach = std::min(frame.end, newest);
  if (reach - from < kSameTime) return;
  // It rested until now; without this key it would creep from where it was last told to be.
  if (from - told_until_ > kSameTime) movement.keys.push_back({frame.simulated(from), reached_->pose});
  const int count = static_cast<int>(std::ceil((reach - from) / kKeySpacing - kSameTime));
  for (int k = 1; k <= count; ++k) {
    const double time = k == count ? reach : from + k * (reach - from) / count;
    const Place place{time, poseAt(time)};
    if (const auto jump = jumpTo(place)) {
      // Poses between the ends of a jump are the source's interpolation; the robot was never there.
      const double landing = std::isfinite(newest) ? newest : reach;
      reached_ = Place{landing, poseAt(landing)};
      told_until_ = frame.start;
      movement.placed = reached_->pose;
      movement.keys.clear();
      movement.jump = jump;
      return;
    }
    movement.keys.push_back({frame.simulated(time), place.pose});
    reached_ = place;
    told_until_ = time;
  }
}

std::optional<Movement::Jump> PoseTrack::jumpTo(const Place& place) const {
  const Movement::Jump jump{farthestMove(box_, reached_->pose, place.pose), place.time - reached_->time};
  if (jump.distance <= fastest_ * jump.duration) return std::nullopt;
  return jump;
}

}  // namespace shallow_sand
