#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "random_fields.h"
#include "random_seed.h"
#include "shallow_sand/ros/frame_clock.h"

namespace shallow_sand {
namespace {

double randomRate(std::mt19937& random) { return std::exp(uniform(random, std::log(0.01), std::log(1e4))); }

TEST(FrameClock, CutsTimeAtTheSameInstantsHoweverItIsAsked) {
  std::mt19937 random = seededGenerator();
  for (int number = 0; number < 20; ++number) {
    const double rate = randomRate(random);
    const ros::Time start(uniform(random, 1.0, 2e9));
    std::set<std::uint64_t> ends[2];
    for (std::set<std::uint64_t>& of_run : ends) {
      FrameClock clock(rate);
      EXPECT_EQ(clock.due(start), 0);
      ros::Time now = start;
      for (int k = 0; k < 200; ++k) {
        now += ros::Duration(uniform(random, 0.0, 0.4));
        for (std::int64_t due = clock.due(now); due > 0; --due) {
          const ros::Time end = clock.next();
          ASSERT_LE(end, now);
          if ((end - start).toSec() < 10.0) of_run.insert(end.toNSec());
        }
      }
      EXPECT_EQ(clock.givenUp(), 0.0);
    }
    EXPECT_EQ(ends[0], ends[1]);
    EXPECT_NEAR(static_cast<double>(ends[0].size()) * FrameClock(rate).length(), 10.0, 0.11);
  }
}

TEST(FrameClock, FramesAreNoLongerThanATenthOfASecondAndSumUpExactly) {
  std::mt19937 random = seededGenerator();
  for (int number = 0; number < 100; ++number) {
    const double rate = randomRate(random);
    const FrameClock clock(rate);
    EXPECT_LE(clock.length(), 0.1 + 1e-8);
    // A whole number of frames in each period of the rate.
    const double parts = 1.0 / (rate * clock.length());
    EXPECT_NEAR(parts / std::round(parts), 1.0, 2e-5);
    double sum = 0.0;
    const int count = randomCount(random, 1, 100000);
    for (int k = 0; k < count; ++k) sum += clock.length();
    EXPECT_EQ(sum, count * clock.length());
  }
}

TEST(FrameClock, GivesUpWhatLiesTooFarBackAndSaysSo) {
  std::mt19937 random = seededGenerator();
  for (int number = 0; number < 50; ++number) {
    FrameClock clock(uniform(random, 5.0, 1000.0));
    ros::Time now(uniform(random, 1.0, 1e9));
    clock.due(now);
    const ros::Time start = clock.end();
    double taken = 0.0;
    for (int k = 0; k < 20; ++k) {
      const double elapsed = uniform(random, 0.0, 1.0);
      now += ros::Duration(elapsed);
      const std::int64_t due = clock.due(now);
      EXPECT_LE(static_cast<double>(due) * clock.length(), FrameClock::kMostBehind + 1e-6);
      if (elapsed > FrameClock::kMostBehind + 2.0 * clock.length()) {
        EXPECT_EQ(due, 1);
      }
      const auto some = static_cast<std::int64_t>(uniform(random, 0.0, 1.0) * static_cast<double>(due + 1));
      for (std::int64_t frame = 0; frame < some; ++frame, taken += clock.length()) clock.next();
    }
    const double passed = (clock.end() - start).toSec();
    // Half a nanosecond a frame.
    EXPECT_NEAR(taken + clock.givenUp(), passed, 1e-9 * passed / clock.length());
  }
}

TEST(FrameClock, TakesOtherRatesAndLosesNoMoreThanAPieceOfAFrame) {
  std::mt19937 random = seededGenerator();
  for (int number = 0; number < 50; ++number) {
    FrameClock clock(uniform(random, 5.0, 1000.0));
    clock.setRate(uniform(random, 5.0, 1000.0));
    ros::Time now(uniform(random, 1.0, 2e9));
    clock.due(now);
    const ros::Time start = clock.end();
    double taken = 0.0;
    double frames = 0.0;
    for (int k = 0; k < 200; ++k) {
      if (k % 10 == 0) {
        const ros::Time before = clock.end();
        const double given_up = clock.givenUp();
        clock.setRate(uniform(random, 5.0, 1000.0));
        const double piece = (clock.end() - before).toSec();
        EXPECT_GE(piece, 0.0);
        EXPECT_LT(piece, clock.length());
        EXPECT_NEAR(clock.givenUp() - given_up, piece, 1e-6);
      }
      now += ros::Duration(uniform(random, 0.0, 0.3));
      for (std::int64_t due = clock.due(now); due > 0; --due, ++frames) {
        const ros::Time before = clock.end();
        const ros::Time end = clock.next();
        EXPECT_NEAR((end - before).toSec(), clock.length(), 1e-8);
        EXPECT_LE(end, now);
        taken += clock.length();
      }
      EXPECT_LT((now - clock.end()).toSec(), clock.length() + 1e-8);
    }
    // It lies where one that had this rate from the start lies.
    const double rate = uniform(random, 5.0, 1000.0);
    clock.setRate(rate);
    FrameClock other(rate);
    other.due(clock.end());
    EXPECT_EQ(other.end(), clock.end());
    EXPECT_NEAR(taken + clock.givenUp(), (clock.end() - start).toSec(), 1e-6 + 1e-9 * frames);
  }
}

TEST(FrameClock, StartsAnewAndSkipsWithoutLoss) {
  FrameClock clock(50.0);
  EXPECT_FALSE(clock.hasStarted());
  clock.due(ros::Time(100.0));
  EXPECT_TRUE(clock.hasStarted());
  clock.skipTo(ros::Time(500.011));
  EXPECT_EQ(clock.end(), ros::Time(500.0));
  EXPECT_EQ(clock.due(ros::Time(500.021)), 1);
  clock.restart();
  EXPECT_EQ(clock.due(ros::Time(3.0)), 0);
  EXPECT_EQ(clock.givenUp(), 0.0);
}

}  // namespace
}  // namespace shallow_sand
