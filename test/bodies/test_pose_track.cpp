#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "random_seed.h"
#include "shallow_sand/bodies/motion.h"
#include "shallow_sand/bodies/pose_track.h"

namespace shallow_sand {
namespace {

constexpr double kFrame = 0.02;    // [s]
constexpr double kFastest = 10.0;  // [m/s]
const Eigen::AlignedBox3d kBox(Eigen::Vector3d(-0.1, -0.2, -0.3), Eigen::Vector3d(0.1, 0.2, 0.3));

/// A body that goes along x at `speed` while it turns about z at `rate`.
struct Path {
  double speed = 0.5;  // [m/s]
  double rate = 0.8;   // [rad/s]
  Eigen::Isometry3d poseAt(double time) const {
    return Eigen::Translation3d(speed * time, 0.0, 0.0) *
           Eigen::AngleAxisd(rate * time, Eigen::Vector3d::UnitZ());
  }
};

/// What tf does: keeps samples, interpolates between them, refuses what lies outside.
class Source {
 public:
  void add(double time, const Eigen::Isometry3d& pose) {
    if (motion_.empty()) first_ = time;
    motion_.append(time, pose);
    newest_ = time;
  }
  double newest() const { return newest_; }
  PoseTrack::PoseSource poses() const {
    return [this](double time) {
      if (time < first_ || time > newest_) throw std::out_of_range("extrapolation");
      return motion_.poseAt(time);
    };
  }

 private:
  Motion motion_;
  double first_ = 0.0;
  double newest_ = -std::numeric_limits<double>::infinity();
};

/// What the simulator does with movements.
class Follower {
 public:
  Movement follow(double start, double end, double newest, const PoseTrack::PoseSource& poses) {
    now_ = simulated_;
    simulated_ += std::min(end - start, 0.1);
    const Movement movement = track.follow({start, end, simulated_}, newest, poses);
    if (movement.placed) {
      motion = Motion();
      motion.append(now_, *movement.placed);
    }
    for (const Movement::Key& key : movement.keys) motion.append(key.time, key.pose);
    return movement;
  }
  /// Simulated time, `part` of the way through the last frame.
  double within(double part) const { return now_ + part * (simulated_ - now_); }

  PoseTrack track{kBox, kFastest};
  Motion motion;

 private:
  double now_ = 0.0;
  double simulated_ = 0.0;
};

double speedIn(const Motion& motion, double time) { return motion.twistAt(time).linear.norm(); }

struct Rate {
  double hertz;
  double latency;  // at most [s]
  double delay;    // of the frames behind now [s]
};

class AtRate : public testing::TestWithParam<Rate> {};

/// Samples come at uneven times and late, frames run at their own rate: the body's speed is the path's at
/// every time, and it is where the path has it.
TEST_P(AtRate, speedIsThatOfThePath) {
  const Rate rate = GetParam();
  std::mt19937 generator = seededGenerator();
  std::uniform_real_distribution<double> share(0.0, 1.0);
  const Path path;
  Source source;
  Follower follower;
  double stamp = 0.0;
  double arrival = 0.0;
  for (double now = 0.5; now < 6.0; now += kFrame) {
    while (arrival <= now) {
      source.add(stamp, path.poseAt(stamp));
      stamp += (0.8 + 0.4 * share(generator)) / rate.hertz;
      arrival = std::max(arrival, stamp + rate.latency * share(generator));
    }
    const double end = now - rate.delay;
    const Movement movement = follower.follow(end - kFrame, end, source.newest(), source.poses());
    EXPECT_EQ(movement.placed.has_value(), now == 0.5) << "at " << now;
    EXPECT_FALSE(movement.jump);
    for (const double part : {0.25, 0.5, 1.0}) {
      const double simulated = follower.within(part);
      const Twist twist = follower.motion.twistAt(simulated);
      EXPECT_NEAR(twist.linear.x(), path.speed, 1e-6);
      EXPECT_NEAR(twist.angular.z(), path.rate, 1e-6);
      const Eigen::Isometry3d expected = path.poseAt(end - (1.0 - part) * kFrame);
      EXPECT_TRUE(follower.motion.poseAt(simulated).isApprox(expected, 1e-6));
    }
  }
}

// A delay of one and a fifth periods and the latency is what it takes.
INSTANTIATE_TEST_SUITE_P(PoseTrack, AtRate,
                         testing::Values(Rate{10.0, 0.02, 0.15}, Rate{20.0, 0.03, 0.1}, Rate{30.0, 0.05, 0.1},
                                         Rate{50.0, 0.05, 0.1}, Rate{100.0, 0.08, 0.1}));

/// Poses that come too late: the body stops and is put in place without a kick; it is never faster than the
/// path. What the track tells of the lateness is what the delay lacks.
TEST(PoseTrack, waitsForLatePosesAndNeverRaces) {
  const Path path;
  Source source;
  Follower follower;
  const double period = 0.1;
  const double delay = 0.05;
  double stamp = 0.0;
  double most_late = 0.0;
  int placed = 0;
  for (double now = 0.5; now < 6.0; now += kFrame) {
    for (; stamp <= now; stamp += period) source.add(stamp, path.poseAt(stamp));
    const double end = now - delay;
    const Movement movement = follower.follow(end - kFrame, end, source.newest(), source.poses());
    most_late = std::max(most_late, movement.late);
    placed += movement.placed ? 1 : 0;
    for (const double part : {0.01, 0.5, 1.0}) {
      EXPECT_LE(speedIn(follower.motion, follower.within(part)), path.speed * (1.0 + 1e-6));
    }
    EXPECT_FALSE(movement.jump);
  }
  EXPECT_GT(placed, 40);
  EXPECT_GT(most_late, period - delay - kFrame - 1e-6);
  EXPECT_LT(most_late, period - delay + 1e-6);
}

/// A frame that took long leaves out a stretch of time: the body crosses it without speed.
TEST(PoseTrack, leavesOutTimeThatTheSandGaveUp) {
  const Path path;
  Follower follower;
  const auto poses = [&](double time) { return path.poseAt(time); };
  follower.follow(0.0, 0.02, 10.0, poses);
  const Movement movement = follower.follow(1.0, 1.1, 10.0, poses);
  ASSERT_TRUE(movement.placed);
  EXPECT_NEAR(movement.placed->translation().x(), path.speed * 1.0, 1e-12);
  EXPECT_EQ(movement.late, 0.0) << "the frames were late, not the poses";
  EXPECT_EQ(movement.keys.size(), 5u);
  for (const double part : {0.1, 0.5, 1.0}) {
    EXPECT_NEAR(speedIn(follower.motion, follower.within(part)), path.speed, 1e-3);
  }
}

TEST(PoseTrack, holdsWhenPosesStop) {
  const Path path;
  Follower follower;
  const auto poses = [&](double time) { return path.poseAt(time); };
  follower.follow(0.0, 0.02, 10.0, poses);
  follower.follow(0.02, 0.04, 0.03, poses);
  for (double start = 0.04; start < 3.0; start += kFrame) {
    const Movement movement = follower.follow(start, start + kFrame, 0.03, poses);
    EXPECT_FALSE(movement.placed);
    EXPECT_TRUE(movement.keys.empty());
    EXPECT_EQ(speedIn(follower.motion, follower.within(1.0)), 0.0);
  }
  EXPECT_NEAR(follower.motion.poseAt(follower.within(1.0)).translation().x(), path.speed * 0.03, 1e-12);
}

/// Stopped within a frame and moved on in the next: it must not creep through the time it rested.
TEST(PoseTrack, restsUntilThePoseItIsAheadOfComes) {
  const auto jumping = [](double time) -> Eigen::Isometry3d {
    return Eigen::Isometry3d(Eigen::Translation3d(time < 0.05 ? 0.0 : 5.0 + 0.5 * (time - 0.05), 0.0, 0.0));
  };
  Follower follower;
  follower.follow(0.02, 0.04, 0.13, jumping);
  const Movement movement = follower.follow(0.04, 0.06, 0.13, jumping);
  ASSERT_TRUE(movement.jump);
  EXPECT_NEAR(movement.jump->distance, 5.005, 1e-12);
  EXPECT_NEAR(movement.jump->duration, 0.02, 1e-12);
  ASSERT_TRUE(movement.placed);
  EXPECT_NEAR(movement.placed->translation().x(), 5.04, 1e-12) << "put at the newest pose";
  EXPECT_TRUE(movement.keys.empty());
  for (double start = 0.06; start < 0.13; start += kFrame) {
    follower.follow(start, start + kFrame, 0.3, jumping);
    EXPECT_EQ(speedIn(follower.motion, follower.within(0.4)), 0.0);
  }
  EXPECT_NEAR(speedIn(follower.motion, follower.within(0.9)), 0.5, 1e-9) << "from 0.13 s on";
}

/// Interpolation spreads a jump over the time between two samples; the body is put at its end all the same.
TEST(PoseTrack, anInterpolatedJumpLeavesNoTraceOnTheWay) {
  Source source;
  for (int k = 0; k <= 10; ++k) {
    source.add(0.1 * k, Eigen::Isometry3d(Eigen::Translation3d(k < 5 ? 0.0 : 3.0, 0.0, 0.0)));
  }
  Follower follower;
  int jumps = 0;
  for (double start = 0.1; start < 0.9; start += kFrame) {
    const double newest = std::floor((start + 0.1 + 1e-9) / 0.1) * 0.1;
    jumps += follower.follow(start, start + kFrame, newest, source.poses()).jump ? 1 : 0;
    const double x = follower.motion.poseAt(follower.within(1.0)).translation().x();
    EXPECT_TRUE(std::abs(x) < 1e-9 || std::abs(x - 3.0) < 1e-9) << x;
    EXPECT_LT(speedIn(follower.motion, follower.within(1.0)), 1e-9);
  }
  EXPECT_EQ(jumps, 1);
}

/// The limit is on the farthest corner: a turn can be a jump, too.
TEST(PoseTrack, limitsTheSpeedOfTheFarthestPoint) {
  const double radius = std::hypot(0.1, 0.2);
  for (const double factor : {0.95, 1.05}) {
    const Path path{0.0, factor * kFastest / radius};
    Follower follower;
    const auto poses = [&](double time) { return path.poseAt(time); };
    EXPECT_EQ(follower.follow(0.0, 0.001, 10.0, poses).jump.has_value(), factor > 1.0);
  }
}

TEST(PoseTrack, staysAsItWasWhenAPoseCannotBeHad) {
  const Path path;
  Follower follower;
  const auto poses = [&](double time) { return path.poseAt(time); };
  const auto nothing = [](double) -> Eigen::Isometry3d { throw std::out_of_range("no pose"); };
  EXPECT_THROW(follower.track.follow({0.0, 0.02, 0.02}, 10.0, nothing), std::out_of_range);
  EXPECT_TRUE(follower.follow(0.0, 0.02, 10.0, poses).placed) << "the first pose";
  EXPECT_THROW(follower.track.follow({0.02, 0.04, 0.04}, 10.0, nothing), std::out_of_range);
  EXPECT_FALSE(follower.follow(0.02, 0.04, 10.0, poses).placed) << "goes on";
}

TEST(PoseTrack, aRestartPutsTheBodyAtItsNextPose) {
  const Path path;
  Follower follower;
  const auto poses = [&](double time) { return path.poseAt(time); };
  follower.follow(100.0, 100.02, 200.0, poses);
  follower.track.restart();
  const Movement movement = follower.follow(0.0, 0.02, 200.0, poses);
  ASSERT_TRUE(movement.placed);
  EXPECT_FALSE(movement.jump);
  EXPECT_NEAR(movement.placed->translation().x(), 0.0, 1e-12);
}

/// A transform that holds for ever: newest is infinite.
TEST(PoseTrack, restsAtAPoseThatHoldsForEver) {
  Follower follower;
  const double ever = std::numeric_limits<double>::infinity();
  const auto poses = [](double) { return Eigen::Isometry3d::Identity(); };
  EXPECT_TRUE(follower.follow(0.0, 0.02, ever, poses).placed);
  for (int k = 1; k < 10; ++k) {
    EXPECT_FALSE(follower.follow(k * kFrame, (k + 1) * kFrame, ever, poses).placed);
    EXPECT_EQ(speedIn(follower.motion, follower.within(1.0)), 0.0);
  }
}

}  // namespace
}  // namespace shallow_sand
