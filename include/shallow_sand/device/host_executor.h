#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <memory>
#include <type_traits>
#include <vector>

#include "shallow_sand/device/cell_mask.h"
#include "shallow_sand/device/helping_threads.h"
#include "shallow_sand/device/window.h"
#include "shallow_sand/device/worth_of_help.h"

namespace shallow_sand {

/// Memory for a field, from a cache line on; all bytes are 0.
class FieldMemory {
 public:
  /// @throws std::bad_alloc
  explicit FieldMemory(std::size_t bytes);
  void* begin() const { return begin_; }

 private:
  struct Free {
    void operator()(void* block) const { std::free(block); }
  };
  std::unique_ptr<void, Free> block_;
  void* begin_;
};

/// Runs functions of a cell on the CPU, rows and tasks shared with helping threads. One thread at a time may
/// call it and its copies.
/// Every cell is computed from values that no other cell of the same call writes, so the number of threads
/// changes no bit.
class HostExecutor {
 public:
  /// A few values before the begin and past the end may be read, up to two vectors of floats: a loop over
  /// rows need not stop short.
  template <class T>
  class Memory {
   public:
    explicit Memory(std::size_t count, T value = T{}) : size_(count), memory_((count + kMargin) * sizeof(T)) {
      if (!isZero(value)) std::uninitialized_fill_n(data(), count + kMargin, value);
    }
    std::size_t size() const { return size_; }
    T* data() { return static_cast<T*>(memory_.begin()); }
    const T* data() const { return static_cast<const T*>(memory_.begin()); }
    void upload(const T* source, std::size_t count) { std::copy_n(source, count, data()); }
    void download(T* target, std::size_t count) const { std::copy_n(data(), count, target); }

   private:
    static_assert(std::is_trivially_copyable<T>::value, "elements are made of bytes that are 0");
    static bool isZero(const T& value) {
      const unsigned char zeros[sizeof(T)] = {};
      return std::memcmp(&value, zeros, sizeof(T)) == 0;
    }
    static constexpr std::size_t kMargin = 32;
    std::size_t size_;
    FieldMemory memory_;
  };

  explicit HostExecutor(int threads) : threads_(threads), team_(std::make_shared<Team>(threads - 1)) {}

  /// Calls function(i, j) once for every cell of the window.
  template <class Function>
  void forEachCell(const Window& window, const Function& function) const {
    forEachRow(window, [&](int j) {
#pragma omp simd
      for (int i = window.column_begin; i < window.column_end; ++i) function(i, j);
    });
  }

  /// Calls function(part) once for each of `count` uneven parts of the work on a window.
  template <class Function>
  void forEachPart(const Window& window, int count, const Function& function) const {
    if (window.cells() < 512) {
      for (int part = 0; part < count; ++part) function(part);
      return;
    }
    forEachTask(count, [&](int part, int) { function(part); });
  }

  /// Cells of which only some need work.
  using Cells = CellMask;

  /// Cells for which value(i, j) is above 0.
  template <class Value>
  Cells cellsWith(const Window& window, const Value& value) const {
    Cells cells(window);
    forEachRow(window, [&](int j) {
      for (int i = window.column_begin; i < window.column_end; ++i) {
        if (value(i, j) > 0.0f) cells.set(i, j);
      }
    });
    return cells;
  }

  /// Those of some cells for which it is.
  template <class Value>
  Cells cellsWith(const Cells& some, const Value& value) const {
    Cells cells(some.window());
    forEachCell(some, [&](int i, int j) {
      if (value(i, j) > 0.0f) cells.set(i, j);
    });
    return cells;
  }

  Cells grown(const Cells& cells) const { return cells.grown(); }

  /// Whether value(i, j) is above 0 for any cell of the window.
  template <class Function>
  static bool holdsAny(const Window& window, const Function& function) {
    for (int j = window.row_begin; j < window.row_end; ++j) {
      for (int i = window.column_begin; i < window.column_end; ++i) {
        if (function(i, j) > 0.0f) return true;
      }
    }
    return false;
  }

  /// Whether it is for any of the cells.
  template <class Value>
  bool holdsAny(const Cells& cells, const Value& value) const {
    bool any = false;
    const Window& window = cells.window();
    for (int j = window.row_begin; j < window.row_end && !any; ++j)
      cells.forEachInRow(j, [&](int i, int row) { any = any || value(i, row) > 0.0f; });
    return any;
  }

  /// Calls function(i, j) once for each of the cells.
  template <class Function>
  void forEachCell(const Cells& cells, const Function& function) const {
    forEachRow(cells.window(), [&](int j) { cells.forEachInRow(j, function); });
  }

  /// Largest function(i, j) over the window, at least 0.
  template <class Function>
  float maximumOverCells(const Window& window, const Function& function) const {
    std::vector<float> largest(window.empty() ? 0 : window.rows(), 0.0f);
    forEachRow(window, [&](int j) {
      float result = 0.0f;
      for (int i = window.column_begin; i < window.column_end; ++i) result = maximum(result, function(i, j));
      largest[j - window.row_begin] = result;
    });
    return largest.empty() ? 0.0f : *std::max_element(largest.begin(), largest.end());
  }

  /// Parts of the window that hold all cells for which function(i, j) is above 0, and few others.
  template <class Function>
  std::vector<Window> partsWith(const Window& window, const Function& function) const {
    constexpr int kColumns = 32;
    constexpr int kRows = 8;
    std::vector<Window> parts;
    for (int j = window.row_begin; j < window.row_end; j += kRows) {
      for (int i = window.column_begin; i < window.column_end; i += kColumns) {
        const Window part = Window{i, j, i + kColumns, j + kRows}.overlap(window);
        if (holdsAny(part, function)) parts.push_back(part);
      }
    }
    return parts;
  }

  /// Calls function(task, thread) once for each of `count` tasks, the thread's number being below threads().
  /// Every thread begins with a share of its own and then helps the others: one that the machine takes away
  /// for another process holds up no more than the task that it is at.
  template <class Function>
  void forEachTask(int count, const Function& function) const {
    const int threads = std::min(threads_, count);
    if (threads <= 1 || !team_->worth.ask(seconds())) {
      for (int task = 0; task < count; ++task) function(task, 0);
      return;
    }
    std::vector<Share> shares(threads);
    const auto first = [&](int share) { return static_cast<int>(1LL * count * share / threads); };
    for (int share = 0; share < threads; ++share) shares[share].next = first(share);
    double end_here = 0.0;
    team_->threads.run([&](int thread) {
      if (thread >= threads) return;
      const double cpu_begin = thread > 0 ? cpuSeconds() : 0.0;
      for (int help = 0; help < threads; ++help) {
        const int share = (thread + help) % threads;
        const int end = first(share + 1);
        for (int task = shares[share].next++; task < end; task = shares[share].next++) function(task, thread);
      }
      if (thread > 0) {
        shares[thread].helped = cpuSeconds() - cpu_begin;
      } else {
        end_here = seconds();
      }
    });
    const double end = seconds();
    double helped = 0.0;
    for (const Share& share : shares) helped += share.helped;
    team_->worth.book(helped, end - end_here, end);
  }

  int threads() const { return threads_; }

 private:
  /// Calls function(j) once for every row, with help if that may be worth it: to wake a thread takes as long
  /// as ten thousand cells.
  template <class Function>
  void forEachRow(const Window& window, const Function& function) const {
    constexpr int kCellsOfTask = 8192;
    if (window.empty()) return;
    const int together = std::max(1, kCellsOfTask / window.columns());
    forEachTask((window.rows() + together - 1) / together, [&](int task, int) {
      const int begin = window.row_begin + task * together;
      const int end = std::min(begin + together, window.row_end);
      for (int j = begin; j < end; ++j) function(j);
    });
  }

  struct alignas(64) Share {  // a cache line of its own
    std::atomic<int> next{0};
    double helped = 0.0;  // [s]
  };

  struct Team {
    explicit Team(int helpers) : threads(helpers) {}
    HelpingThreads threads;
    WorthOfHelp worth;
  };

  static double seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  }

  /// That the calling thread has used. [s]
  static double cpuSeconds() {
    std::timespec time;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }

  int threads_;
  std::shared_ptr<Team> team_;  // of all copies
};

}  // namespace shallow_sand
