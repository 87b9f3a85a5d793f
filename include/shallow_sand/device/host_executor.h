#pragma once

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <type_traits>
#include <vector>

#include "shallow_sand/device/window.h"

namespace shallow_sand {

/// Memory for a field, from a cache line on.
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

/// Runs functions of a cell on the CPU, rows shared among OpenMP threads. Every cell is computed from values
/// that no other cell of the same call writes, so the number of threads changes no bit.
class HostExecutor {
 public:
  /// Values past the end may be read, up to two vectors of floats: a loop over rows need not stop short.
  template <class T>
  class Memory {
   public:
    explicit Memory(std::size_t count, T value = T{}) : size_(count), memory_((count + kMargin) * sizeof(T)) {
      std::uninitialized_fill_n(data(), count + kMargin, value);
    }
    std::size_t size() const { return size_; }
    T* data() { return static_cast<T*>(memory_.begin()); }
    const T* data() const { return static_cast<const T*>(memory_.begin()); }
    void upload(const T* source, std::size_t count) { std::copy_n(source, count, data()); }
    void download(T* target, std::size_t count) const { std::copy_n(data(), count, target); }

   private:
    static_assert(std::is_trivially_destructible<T>::value, "elements are not destroyed one by one");
    static constexpr std::size_t kMargin = 32;
    std::size_t size_;
    FieldMemory memory_;
  };

  explicit HostExecutor(int threads) : threads_(threads) {}

  /// Calls function(i, j) once for every cell of the window.
  template <class Function>
  void forEachCell(const Window& window, const Function& function) const {
#pragma omp parallel for num_threads(threads_) schedule(static) if (window.rows() > 1)
    for (int j = window.row_begin; j < window.row_end; ++j) {
#pragma omp simd
      for (int i = window.column_begin; i < window.column_end; ++i) function(i, j);
    }
  }

  /// Largest function(i, j) over the window, at least 0.
  template <class Function>
  float maximumOverCells(const Window& window, const Function& function) const {
    float result = 0.0f;
#pragma omp parallel for num_threads(threads_) schedule(static) reduction(max : result)
    for (int j = window.row_begin; j < window.row_end; ++j) {
      for (int i = window.column_begin; i < window.column_end; ++i) result = maximum(result, function(i, j));
    }
    return result;
  }

  /// Calls function(task, thread) once for each of `count` tasks, the thread's number being below threads().
  /// Every thread begins with a share of its own and then helps the others: one that the machine takes away
  /// for another process holds up no more than the task that it is at.
  template <class Function>
  void forEachTask(int count, const Function& function) const {
    const int threads = std::min(threads_, count);
    if (threads <= 1) {
      for (int task = 0; task < count; ++task) function(task, 0);
      return;
    }
    std::vector<Share> shares(threads);
    const auto begin = [&](int share) { return static_cast<int>(1LL * count * share / threads); };
    for (int share = 0; share < threads; ++share) shares[share].next = begin(share);
#pragma omp parallel num_threads(threads)
    {
      const int thread = omp_get_thread_num();
      for (int help = 0; help < threads; ++help) {
        const int share = (thread + help) % threads;
        const int end = begin(share + 1);
        for (int task = shares[share].next++; task < end; task = shares[share].next++) function(task, thread);
      }
    }
  }

  int threads() const { return threads_; }

 private:
  struct alignas(64) Share {  // a cache line of its own
    std::atomic<int> next{0};
  };

  int threads_;
};

}  // namespace shallow_sand
