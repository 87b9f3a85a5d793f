#include <cooperative_groups.h>
#include <cuda_runtime.h>

#include <stdexcept>

#include "benchmark/cuda_references.h"

namespace shallow_sand {
namespace {

constexpr int kThreads = 256;  // of a block

void check(cudaError_t status, const char* action) {
  if (status == cudaSuccess) return;
  throw std::runtime_error(std::string("CUDA: ") + action + ": " + cudaGetErrorString(status));
}

void waitForDevice() { check(cudaDeviceSynchronize(), "wait"); }

cudaDeviceProp deviceProperties() {
  cudaDeviceProp properties{};
  check(cudaGetDeviceProperties(&properties, 0), "read the device's properties");
  return properties;
}

/// h, hu and hv, one after the other, `cells` floats each.
__global__ void copyState(const float* in, const float* bed, float* out, std::size_t cells) {
  const std::size_t at = static_cast<std::size_t>(blockIdx.x) * blockDim.x + threadIdx.x;
  if (at >= cells) return;
  out[at] = in[at] + bed[at];
  out[at + cells] = in[at + cells];
  out[at + 2 * cells] = in[at + 2 * cells];
}

__global__ void doNothing() {}

__global__ void synchroniseOnly(int times) {
  const cooperative_groups::grid_group grid = cooperative_groups::this_grid();
  for (int k = 0; k < times; ++k) grid.sync();
}

}  // namespace

DeviceCopy::DeviceCopy(std::size_t cells) : cells_(cells) {
  const std::size_t bytes = kFields * cells * sizeof(float);
  check(cudaMalloc(reinterpret_cast<void**>(&memory_), bytes), "allocate memory");
  check(cudaMemset(memory_, 0, bytes), "clear memory");
}

DeviceCopy::~DeviceCopy() { cudaFree(memory_); }

void DeviceCopy::operator()(int times) {
  const auto blocks = static_cast<unsigned>((cells_ + kThreads - 1) / kThreads);
  for (int k = 0; k < times; ++k) {
    const std::size_t to = 5 - from_;  // states begin at fields 1 and 4
    copyState<<<blocks, kThreads>>>(memory_ + from_ * cells_, memory_, memory_ + to * cells_, cells_);
    check(cudaGetLastError(), "launch");
    from_ = to;
  }
  waitForDevice();
}

void launchEmptyKernels(int times) {
  for (int k = 0; k < times; ++k) doNothing<<<1, kThreads>>>();
  check(cudaGetLastError(), "launch");
  waitForDevice();
}

void synchroniseGrid(int blocks, int times) {
  static const int multiprocessors = deviceProperties().multiProcessorCount;
  void* arguments[] = {&times};
  check(cudaLaunchCooperativeKernel(reinterpret_cast<void*>(synchroniseOnly), dim3(blocks * multiprocessors),
                                    dim3(kThreads), arguments, 0, nullptr),
        "launch");
  waitForDevice();
}

std::string deviceName() { return deviceProperties().name; }

}  // namespace shallow_sand
