#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

#include "shallow_sand/device/host_executor.h"

namespace shallow_sand {
namespace {

TEST(HelpingThreads, DoEveryTaskOnceBeforeTheCallReturns) {
  for (const int threads : {1, 2, 3, 7}) {
    const HostExecutor executor(threads);
    for (int call = 0; call < 2000; ++call) {
      const int count = call % 23;
      std::vector<int> done(count, 0);  // plain values: each task's belongs to one thread
      std::atomic<bool> thread_exists{true};
      executor.forEachTask(count, [&](int task, int thread) {
        done[task] += 1;
        if (thread < 0 || thread >= threads) thread_exists = false;
      });
      ASSERT_EQ(done, std::vector<int>(count, 1)) << threads << " threads, call " << call;
      ASSERT_TRUE(thread_exists);
    }
  }
}

TEST(HelpingThreads, WakeAfterTheySlept) {
  const HostExecutor executor(2);
  for (int call = 0; call < 20; ++call) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    std::atomic<int> done{0};
    executor.forEachTask(64, [&](int, int) { ++done; });
    ASSERT_EQ(done, 64);
  }
}

TEST(WorthOfHelp, AsksAgainAfterALossAndWaitsLongerEachTime) {
  WorthOfHelp worth;
  double now = 1.0;
  EXPECT_TRUE(worth.ask(now));
  double pause_before = 0.0;
  for (int loss = 0; loss < 5; ++loss) {
    worth.book(1e-3, 5e-3, now);
    EXPECT_FALSE(worth.ask(now));
    const double begin = now;
    while (!worth.ask(now)) now += 1e-4;
    EXPECT_GT(now - begin, 1.5 * pause_before);
    pause_before = now - begin;
  }
}

TEST(WorthOfHelp, OneSmallLossIsForgivenWhereHelpPaid) {
  WorthOfHelp worth;
  for (int call = 0; call < 10; ++call) worth.book(1e-3, 0.0, 1.0);
  worth.book(1e-3, 2e-3, 1.0);
  EXPECT_TRUE(worth.ask(1.0));
}

}  // namespace
}  // namespace shallow_sand
