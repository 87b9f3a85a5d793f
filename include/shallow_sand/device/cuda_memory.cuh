#pragma once

#include <cuda_runtime.h>

#include <cstddef>
#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

/// Parameters of kernels marked so stay where the launch has put them when functions refer to them; older
/// compilers copy them.
#if CUDART_VERSION >= 11070
#define SHALLOW_SAND_GRID_CONSTANT __grid_constant__
#else
#define SHALLOW_SAND_GRID_CONSTANT
#endif

namespace shallow_sand {

/// @throws std::runtime_error with what was to be done and CUDA's own words
inline void checkCuda(cudaError_t status, const std::string& action) {
  if (status == cudaSuccess) return;
  cudaGetLastError();  // else the next call that succeeds would tell of it again
  throw std::runtime_error("CUDA cannot " + action + ": " + cudaGetErrorString(status));
}

/// Memory of the GPU. Copies are ordered with all work of CudaStreams and wait for it.
template <class T>
class CudaMemory {
 public:
  explicit CudaMemory(std::size_t count, T value = T{}) : CudaMemory(Raw{}, count) {
    const T zero{};
    if (std::memcmp(&value, &zero, sizeof(T)) == 0) {
      checkCuda(cudaMemset(data_, 0, count * sizeof(T)), "clear memory");
    } else {
      const std::vector<T> values(count, value);
      upload(values.data(), count);
    }
  }
  explicit CudaMemory(const std::vector<T>& values) : CudaMemory(Raw{}, values.size()) {
    upload(values.data(), values.size());
  }
  ~CudaMemory() { cudaFree(data_); }
  CudaMemory(CudaMemory&& other) noexcept { swap(other); }
  CudaMemory& operator=(CudaMemory&& other) noexcept {
    swap(other);
    return *this;
  }
  std::size_t size() const { return count_; }
  T* data() { return data_; }
  const T* data() const { return data_; }
  void upload(const T* source, std::size_t count) {
    checkCuda(cudaMemcpy(data_, source, count * sizeof(T), cudaMemcpyHostToDevice), "copy to the GPU");
  }
  void download(T* target, std::size_t count) const {
    checkCuda(cudaMemcpy(target, data_, count * sizeof(T), cudaMemcpyDeviceToHost), "copy from the GPU");
  }

 private:
  struct Raw {};
  CudaMemory(Raw, std::size_t count) : count_(count) {
    const std::size_t bytes = count * sizeof(T);
    checkCuda(cudaMalloc(reinterpret_cast<void**>(&data_), bytes),
              "get " + std::to_string(bytes) + " bytes of the GPU's memory");
  }
  void swap(CudaMemory& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(count_, other.count_);
  }
  T* data_ = nullptr;
  std::size_t count_ = 0;
};

/// Memory of the host that the GPU copies to and from by itself.
template <class T>
class PinnedMemory {
 public:
  explicit PinnedMemory(std::size_t count) : count_(count) {
    const std::size_t bytes = count * sizeof(T);
    checkCuda(cudaMallocHost(reinterpret_cast<void**>(&data_), bytes),
              "get " + std::to_string(bytes) + " bytes of pinned memory");
  }
  ~PinnedMemory() { cudaFreeHost(data_); }
  PinnedMemory(PinnedMemory&& other) noexcept { swap(other); }
  PinnedMemory& operator=(PinnedMemory&& other) noexcept {
    swap(other);
    return *this;
  }
  std::size_t size() const { return count_; }
  T* data() { return data_; }
  T& operator[](std::size_t k) { return data_[k]; }

 private:
  void swap(PinnedMemory& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(count_, other.count_);
  }
  T* data_ = nullptr;
  std::size_t count_ = 0;
};

/// A stream of work, one after the other.
class CudaStream {
 public:
  CudaStream() { checkCuda(cudaStreamCreate(&stream_), "make a stream"); }
  ~CudaStream() { cudaStreamDestroy(stream_); }
  CudaStream(const CudaStream&) = delete;
  CudaStream& operator=(const CudaStream&) = delete;
  operator cudaStream_t() const { return stream_; }
  /// @param what the GPU did, for the error
  void wait(const char* what) const { checkCuda(cudaStreamSynchronize(stream_), what); }

 private:
  cudaStream_t stream_ = nullptr;
};

/// A point in a stream for which others wait.
class CudaEvent {
 public:
  CudaEvent() { checkCuda(cudaEventCreateWithFlags(&event_, cudaEventDisableTiming), "make an event"); }
  ~CudaEvent() { cudaEventDestroy(event_); }
  CudaEvent(const CudaEvent&) = delete;
  CudaEvent& operator=(const CudaEvent&) = delete;
  void record(const CudaStream& stream) { checkCuda(cudaEventRecord(event_, stream), "record an event"); }
  void letWait(const CudaStream& stream) const {
    checkCuda(cudaStreamWaitEvent(stream, event_, 0), "let a stream wait");
  }

 private:
  cudaEvent_t event_ = nullptr;
};

/// A list that is sent to the GPU anew from time to time, through pinned memory. It may be set again once the
/// stream has taken it.
template <class T>
class SentList {
 public:
  /// Grows if it must: an exception for lists that get longer, not in every call.
  void send(const std::vector<T>& values, const CudaStream& stream) {
    if (values.size() > memory_.size()) {
      const std::size_t room = 2 * values.size();
      CudaMemory<T> memory(room);
      PinnedMemory<T> pinned(room);
      memory_ = std::move(memory);
      pinned_ = std::move(pinned);
    }
    if (values.empty()) return;
    std::memcpy(pinned_.data(), values.data(), values.size() * sizeof(T));
    checkCuda(cudaMemcpyAsync(memory_.data(), pinned_.data(), values.size() * sizeof(T),
                              cudaMemcpyHostToDevice, stream),
              "copy to the GPU");
  }
  T* data() { return memory_.data(); }

 private:
  CudaMemory<T> memory_{0};
  PinnedMemory<T> pinned_{0};
};

}  // namespace shallow_sand
