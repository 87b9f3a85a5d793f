#pragma once

#include <omp.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "shallow_sand/device/window.h"

namespace shallow_sand {

/// Runs functions of a cell on the CPU, rows shared among OpenMP threads. Every cell is computed from values
/// that no other cell of the same call writes, so the number of threads changes no bit.
class HostExecutor {
 public:
  template <class T>
  class Memory {
   public:
    explicit Memory(std::size_t count, T value = T{}) : values_(count, value) {}
    std::size_t size() const { return values_.size(); }
    T* data() { return values_.data(); }
    const T* data() const { return values_.data(); }
    void upload(const T* source, std::size_t count) { std::copy(source, source + count, values_.begin()); }
    void download(T* target, std::size_t count) const {
      const auto begin = values_.begin();
      std::copy(begin, begin + static_cast<std::ptrdiff_t>(count), target);
    }

   private:
    std::vector<T> values_;
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

  /// Calls function(begin, end) once for each thread, with its share of the rows.
  template <class Function>
  void forEachBand(int rows, const Function& function) const {
#pragma omp parallel for num_threads(threads_) schedule(static)
    for (int band = 0; band < threads_; ++band) {
      const long long n = rows;
      function(static_cast<int>(n * band / threads_), static_cast<int>(n * (band + 1) / threads_));
    }
  }

 private:
  int threads_;
};

}  // namespace shallow_sand
