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

/// Windows that fall into many tasks, into some of one row each, and into none.
TEST(HelpingThreads, ComputeEveryCellOnce) {
  for (const Window& window :
       {Window{3, 2, 403, 302}, Window{0, 0, 20000, 9}, Window{5, 0, 6, 9000}, Window{}}) {
    for (const int threads : {1, 2, 3, 7}) {
      const HostExecutor executor(threads);
      constexpr int kAcross = 20000;
      std::vector<unsigned char> done(window.empty() ? 0 : std::size_t{kAcross} * window.row_end, 0);
      const auto cell = [&](int i, int j) { return static_cast<std::size_t>(j) * kAcross + i; };
      const auto count = [&](int i, int j) { done[cell(i, j)] += 1; };
      executor.forEachCell(window, count);
      const auto some =
          executor.cellsWith(window, [](int i, int j) { return (7 * i + 3 * j) % 5 == 0 ? 1.0f : 0.0f; });
      executor.forEachCell(some, count);
      for (int j = window.row_begin; j < window.row_end; ++j) {
        for (int i = window.column_begin; i < window.column_end; ++i)
          ASSERT_EQ(done[cell(i, j)], (7 * i + 3 * j) % 5 == 0 ? 2 : 1)
              << i << ", " << j << ", " << threads << " threads";
      }
      EXPECT_EQ(executor.maximumOverCells(window, [&](int i, int j) { return static_cast<float>(i + j); }),
                window.empty() ? 0.0f : static_cast<float>(window.column_end + window.row_end - 2));
    }
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
