#include "shallow_sand/bodies/motion.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <string>

#include "shallow_sand/core/parameters.h"

namespace shallow_sand {
namespace {

template <typename Value>
std::string text(const Value& value) {
  std::ostringstream stream;
  stream << value;
  return stream.str();
}

void requireRigid(const Eigen::Isometry3d& pose) {
  const Eigen::IOFormat on_one_line(Eigen::StreamPrecision, Eigen::DontAlignCols, ", ", "; ");
  const Eigen::Matrix3d rotation = pose.linear();
  if (!isWithinReach(pose) || !rotation.allFinite()) {
    throw InvalidParameter("pose", text(pose.matrix().topRows<3>().format(on_one_line)),
                           "finite numbers, and metres up to 1e9");
  }
  const double stretch =
      (rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (stretch > 1e-3 || rotation.determinant() <= 0.0) {
    throw InvalidParameter("pose", text(rotation.format(on_one_line)),
                           "a rotation: orthonormal within 1e-3 and not mirrored");
  }
}

}  // namespace

bool isWithinReach(const Eigen::Isometry3d& pose) { return (pose.translation().array().abs() <= 1e9).all(); }

Twist twistOf(const Eigen::Vector3d& way, const Eigen::AngleAxisd& turn, double duration) {
  return {way / duration, turn.axis() * (turn.angle() / duration)};
}

void Motion::append(double time, const Eigen::Isometry3d& pose) {
  if (!std::isfinite(time)) throw InvalidParameter("time", text(time), "a finite time in seconds");
  if (!keys_.empty() && time <= keys_.back().time) {
    throw InvalidParameter("time", text(time) + " s",
                           "a time after that of the last pose, " + text(keys_.back().time) + " s");
  }
  requireRigid(pose);
  keys_.push_back({time, pose.translation(), Eigen::Quaterniond(pose.linear()).normalized()});
}

void Motion::forgetBefore(double time) {
  while (keys_.size() > 1 && keys_[1].time < time) keys_.pop_front();
}

int Motion::segmentAt(double time) const {
  const auto next = std::lower_bound(keys_.begin(), keys_.end(), time,
                                     [](const Key& key, double value) { return key.time < value; });
  if (next == keys_.begin() || next == keys_.end()) return -1;
  return static_cast<int>(std::distance(keys_.begin(), next)) - 1;
}

Eigen::Isometry3d Motion::poseAt(double time) const {
  if (keys_.empty()) throw std::logic_error("Motion::poseAt: no pose was appended");
  const int segment = segmentAt(time);
  const Key& from = segment < 0 ? keys_.front() : keys_[static_cast<std::size_t>(segment)];
  const Key& to = segment < 0 ? keys_.back() : keys_[static_cast<std::size_t>(segment) + 1];
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  if (time <= from.time || time >= to.time) {
    const Key& held = time <= from.time ? from : to;
    pose.translation() = held.position;
    pose.linear() = held.rotation.toRotationMatrix();
    return pose;
  }
  const double part = (time - from.time) / (to.time - from.time);
  pose.translation() = from.position + part * (to.position - from.position);
  pose.linear() = from.rotation.slerp(part, to.rotation).normalized().toRotationMatrix();
  return pose;
}

Twist Motion::twistAt(double time) const {
  const int segment = segmentAt(time);
  if (segment < 0) return {};
  const Key& from = keys_[static_cast<std::size_t>(segment)];
  const Key& to = keys_[static_cast<std::size_t>(segment) + 1];
  // Left of `from`, the turn's axis is one of the grid's frame; AngleAxis takes the short way round, as slerp
  // does.
  const Eigen::AngleAxisd turn(to.rotation * from.rotation.conjugate());
  return twistOf(to.position - from.position, turn, to.time - from.time);
}

}  // namespace shallow_sand
