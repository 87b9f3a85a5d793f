#pragma once

#include <cstddef>
#include <string>

/// What a GPU takes for what no step can do without. Kernels of their own, so that they measure the GPU and
/// not the engine. All of this throws std::runtime_error with CUDA's own words.
namespace shallow_sand {

/// Moves the bytes that a step must move, 28 a cell, and computes next to nothing: where memory is what
/// bounds it, no step can be faster.
class DeviceCopy {
 public:
  explicit DeviceCopy(std::size_t cells);
  ~DeviceCopy();
  DeviceCopy(const DeviceCopy&) = delete;
  DeviceCopy& operator=(const DeviceCopy&) = delete;

  /// Copies as often, one after the other, and waits for the last.
  void operator()(int times);

 private:
  static constexpr std::size_t kFields = 7;  // b, and h, hu and hv of two states
  float* memory_ = nullptr;
  std::size_t cells_;
  std::size_t from_ = 1;  // first field of the state that is read
};

/// Launches an empty kernel as often, one after the other, and waits for the last.
void launchEmptyKernels(int times);

/// A cooperative kernel that only synchronises its whole grid, as often as is said; waits for it.
/// @param blocks of 256 threads on each multiprocessor
void synchroniseGrid(int blocks, int times);

/// Name of the current CUDA device.
std::string deviceName();

}  // namespace shallow_sand
