#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "random_seed.h"
#include "shallow_sand/bodies/motion.h"
#include "shallow_sand/core/parameters.h"

namespace shallow_sand {
namespace {

struct TimedPose {
  double time;
  Eigen::Isometry3d pose;
};

double between(std::mt19937& generator, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(generator);
}

Eigen::Isometry3d randomPose(std::mt19937& generator) {
  std::normal_distribution<double> normal;
  Eigen::Quaterniond rotation(normal(generator), normal(generator), normal(generator), normal(generator));
  return Eigen::Translation3d(normal(generator), normal(generator), normal(generator)) *
         rotation.normalized();
}

std::vector<TimedPose> randomKeys(std::mt19937& generator) {
  std::vector<TimedPose> keys;
  double time = between(generator, -10.0, 10.0);
  for (int i = 0; i < 8; ++i) {
    keys.push_back({time, randomPose(generator)});
    time += between(generator, 0.1, 2.0);
  }
  return keys;
}

Motion motionThrough(const std::vector<TimedPose>& keys) {
  Motion motion;
  for (const TimedPose& key : keys) motion.append(key.time, key.pose);
  return motion;
}

double difference(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return (a.matrix() - b.matrix()).cwiseAbs().maxCoeff();
}

/// Key of the error `call` ends with, or what came instead.
template <typename Call>
std::string keyOfError(Call call) {
  try {
    call();
  } catch (const InvalidParameter& error) {
    const std::string message = error.what();
    return message.substr(0, message.find(':'));
  }
  return "no error";
}

constexpr double kRounding = 1e-14;  // to a quaternion and back: some ten operations on numbers below 5

TEST(Motion, passesThroughItsPosesAndRestsOutside) {
  std::mt19937 generator = seededGenerator();
  const std::vector<TimedPose> keys = randomKeys(generator);
  const Motion motion = motionThrough(keys);
  for (const TimedPose& key : keys) {
    EXPECT_EQ(motion.poseAt(key.time).translation(), key.pose.translation());
    EXPECT_LT(difference(motion.poseAt(key.time), key.pose), kRounding);
  }
  EXPECT_LT(difference(motion.poseAt(keys.front().time - 3.0), keys.front().pose), kRounding);
  EXPECT_LT(difference(motion.poseAt(keys.back().time + 3.0), keys.back().pose), kRounding);
  for (const double time : {keys.front().time - 1e-9, keys.front().time, keys.back().time + 3.0}) {
    EXPECT_EQ(motion.twistAt(time).linear, Eigen::Vector3d::Zero());
    EXPECT_EQ(motion.twistAt(time).angular, Eigen::Vector3d::Zero());
  }
}

TEST(Motion, isRigidAtAnyTime) {
  std::mt19937 generator = seededGenerator();
  const std::vector<TimedPose> keys = randomKeys(generator);
  const Motion motion = motionThrough(keys);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Matrix3d rotation =
        motion.poseAt(between(generator, keys[0].time, keys.back().time)).linear();
    EXPECT_LT((rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).norm(), kRounding);
    EXPECT_NEAR(rotation.determinant(), 1.0, kRounding);
  }
}

/// The velocity of a point of the body, by central differences of its path and by the twist.
TEST(Motion, twistIsTheDerivativeOfThePose) {
  std::mt19937 generator = seededGenerator();
  const std::vector<TimedPose> keys = randomKeys(generator);
  const Motion motion = motionThrough(keys);
  for (std::size_t i = 0; i + 1 < keys.size(); ++i) {
    const double step = 1e-4;
    const double time = between(generator, keys[i].time + step, keys[i + 1].time - step);
    const Eigen::Vector3d point(between(generator, -1, 1), between(generator, -1, 1),
                                between(generator, -1, 1));
    const Eigen::Vector3d difference =
        (motion.poseAt(time + step) * point - motion.poseAt(time - step) * point) / (2.0 * step);
    const Twist twist = motion.twistAt(time);
    const Eigen::Vector3d velocity = twist.linear + twist.angular.cross(motion.poseAt(time).linear() * point);
    // step² / 6 times the third derivative, |ω|³·|point|, and the rounding of positions over the step.
    const double tolerance =
        step * step / 6.0 * std::pow(twist.angular.norm(), 3) * 2.0 + 10.0 * kRounding / step;
    EXPECT_LT((difference - velocity).norm(), tolerance);
    // The way a segment goes is the short one.
    EXPECT_LE(twist.angular.norm() * (keys[i + 1].time - keys[i].time), 3.14159265358979323846 + 1e-9);
  }
}

TEST(Motion, twistIsTheSameAllAlongASegment) {
  std::mt19937 generator = seededGenerator();
  const std::vector<TimedPose> keys = randomKeys(generator);
  const Motion motion = motionThrough(keys);
  const Twist at_start = motion.twistAt(std::nextafter(keys[2].time, keys[3].time));
  const Twist at_end = motion.twistAt(keys[3].time);
  EXPECT_EQ(at_start.linear, at_end.linear);
  EXPECT_EQ(at_start.angular, at_end.angular);
}

TEST(Motion, forgettingChangesNothingFromThenOn) {
  std::mt19937 generator = seededGenerator();
  const std::vector<TimedPose> keys = randomKeys(generator);
  const Motion whole = motionThrough(keys);
  for (const double from :
       {keys[3].time, between(generator, keys[3].time, keys[4].time), keys.back().time + 1.0}) {
    Motion forgetful = whole;
    forgetful.forgetBefore(from);
    for (const double time : {from, from + 0.01, from + 1.0, keys.back().time + 2.0}) {
      EXPECT_EQ(difference(forgetful.poseAt(time), whole.poseAt(time)), 0.0);
      EXPECT_EQ(forgetful.twistAt(time).linear, whole.twistAt(time).linear);
      EXPECT_EQ(forgetful.twistAt(time).angular, whole.twistAt(time).angular);
    }
    EXPECT_FALSE(forgetful.empty());
  }
}

TEST(Motion, refusesWhatIsNoPose) {
  Motion motion;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation().y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(keyOfError([&] { motion.append(0.0, pose); }), "pose");
  pose.translation().y() = -1.1e9;
  EXPECT_EQ(keyOfError([&] { motion.append(0.0, pose); }), "pose");
  pose = Eigen::Isometry3d::Identity();
  pose.linear()(0, 1) = std::numeric_limits<double>::infinity();
  EXPECT_EQ(keyOfError([&] { motion.append(0.0, pose); }), "pose");
  pose.linear() = 1.01 * Eigen::Matrix3d::Identity();
  EXPECT_EQ(keyOfError([&] { motion.append(0.0, pose); }), "pose");
  pose.linear() = Eigen::Vector3d(1.0, 1.0, -1.0).asDiagonal();
  EXPECT_EQ(keyOfError([&] { motion.append(0.0, pose); }), "pose");
  EXPECT_TRUE(motion.empty());
}

TEST(Motion, acceptsARotationRoundedToSinglePrecision) {
  std::mt19937 generator = seededGenerator();
  Eigen::Isometry3d pose = randomPose(generator);
  pose.linear() = pose.linear().cast<float>().cast<double>().eval();
  Motion motion;
  motion.append(0.0, pose);
  // 2⁻²⁴ in each of the three terms of a quaternion's entries, and as much again on the way back.
  EXPECT_LT(difference(motion.poseAt(0.0), pose), 1e-6);
}

TEST(Motion, refusesTimesThatDoNotRise) {
  Motion motion;
  const Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  EXPECT_EQ(keyOfError([&] { motion.append(std::nan(""), pose); }), "time");
  motion.append(1.0, pose);
  EXPECT_EQ(keyOfError([&] { motion.append(1.0, pose); }), "time");
  EXPECT_EQ(keyOfError([&] { motion.append(0.5, pose); }), "time");
  motion.append(1.5, pose);
}

}  // namespace
}  // namespace shallow_sand
