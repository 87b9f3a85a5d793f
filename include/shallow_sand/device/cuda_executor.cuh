#pragma once

#include <cuda_runtime.h>

#include <cstddef>
#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "shallow_sand/device/window.h"

namespace shallow_sand {

inline void checkCuda(cudaError_t status, const char* action) {
  if (status != cudaSuccess) {
    throw std::runtime_error(std::string("CUDA: ") + action + ": " + cudaGetErrorString(status));
  }
}

template <class Function>
__global__ void forEachCellKernel(Window window, Function function) {
  const int i = window.column_begin + static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  const int j = window.row_begin + static_cast<int>(blockIdx.y * blockDim.y + threadIdx.y);
  if (i < window.column_end && j < window.row_end) function(i, j);
}

/// Floats that are not negative are ordered like their bits, so an integer maximum serves, in any order.
template <class Function>
__global__ void maximumKernel(Window window, Function function, int* result) {
  const int i = window.column_begin + static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  const int j = window.row_begin + static_cast<int>(blockIdx.y * blockDim.y + threadIdx.y);
  int value = i < window.column_end && j < window.row_end ? __float_as_int(function(i, j)) : 0;
  for (int offset = 16; offset > 0; offset /= 2)
    value = max(value, __shfl_xor_sync(0xffffffffu, value, offset));
  if (threadIdx.x == 0 && value > 0) atomicMax(result, value);
}

/// Runs functions of a cell on the current CUDA device, in the default stream.
class CudaExecutor {
 public:
  template <class T>
  class Memory {
   public:
    explicit Memory(std::size_t count, T value = T{}) : count_(count) {
      checkCuda(cudaMalloc(reinterpret_cast<void**>(&data_), count * sizeof(T)), "allocate memory");
      const std::vector<T> values(count, value);
      upload(values.data(), count);
    }
    ~Memory() { cudaFree(data_); }
    Memory(Memory&& other) noexcept { swap(other); }
    Memory& operator=(Memory&& other) noexcept {
      swap(other);
      return *this;
    }
    std::size_t size() const { return count_; }
    T* data() { return data_; }
    const T* data() const { return data_; }
    void upload(const T* source, std::size_t count) {
      checkCuda(cudaMemcpy(data_, source, count * sizeof(T), cudaMemcpyHostToDevice), "copy to device");
    }
    void download(T* target, std::size_t count) const {
      checkCuda(cudaMemcpy(target, data_, count * sizeof(T), cudaMemcpyDeviceToHost), "copy to host");
    }

   private:
    void swap(Memory& other) noexcept {
      std::swap(data_, other.data_);
      std::swap(count_, other.count_);
    }
    T* data_ = nullptr;
    std::size_t count_ = 0;
  };

  template <class Function>
  void forEachCell(const Window& window, const Function& function) const {
    if (window.empty()) return;
    forEachCellKernel<<<blocks(window), block()>>>(window, function);
    checkCuda(cudaGetLastError(), "launch");
  }

  /// Cells that hold all of those that are asked for: functions look for themselves whether there is work.
  using Cells = Window;
  template <class Value>
  Cells cellsWith(const Window& window, const Value&) const {
    return window;
  }
  Cells grown(const Cells& cells) const { return cells; }
  template <class Value>
  bool holdsAny(const Cells& cells, const Value& value) {
    return maximumOverCells(cells, value) > 0.0f;
  }

  template <class Function>
  float maximumOverCells(const Window& window, const Function& function) {
    if (window.empty()) return 0.0f;
    const int zero = 0;
    maximum_.upload(&zero, 1);
    maximumKernel<<<blocks(window), block()>>>(window, function, maximum_.data());
    checkCuda(cudaGetLastError(), "launch");
    int bits = 0;
    maximum_.download(&bits, 1);
    return intAsFloat(bits);
  }

  /// Parts of the window that hold all cells for which function(i, j) is above 0: the whole of it, or
  /// nothing.
  template <class Function>
  std::vector<Window> partsWith(const Window& window, const Function& function) {
    if (maximumOverCells(window, function) > 0.0f) return {window};
    return {};
  }

 private:
  static dim3 block() { return dim3(32, 4); }
  static dim3 blocks(const Window& window) {
    return dim3(static_cast<unsigned>((window.columns() + 31) / 32),
                static_cast<unsigned>((window.rows() + 3) / 4));
  }
  static float intAsFloat(int bits) {
    float value;
    static_assert(sizeof(value) == sizeof(bits), "a float has the size of an int");
    std::memcpy(&value, &bits, sizeof(value));
    return value;
  }
  Memory<int> maximum_{1};
};

}  // namespace shallow_sand
