#pragma once

#include <cuda_runtime_api.h>

#include <cstddef>
#include <string>
#include <vector>

/// What the program asked of the CUDA runtime, and failures that it is made to meet. cuda_calls.cpp stands
/// between libraries and the runtime in each program that it is linked into.
namespace shallow_sand {

/// Kernels of all libraries that were not launched so far, by their names in the source.
std::vector<std::string> kernelsNeverLaunched();
std::size_t launches();         ///< of kernels, so far
std::size_t allocations();      ///< of device and pinned memory that were tried so far
std::size_t allocationsHeld();  ///< that succeeded and were not freed yet

/// The runtime's words for an error.
std::string toldByRuntime(cudaError_t error);

/// After `passing` more allocations those of `at_least` bytes fail, as on a device that is full.
void failAllocations(std::size_t at_least, std::size_t passing = 0);
/// After `passing` more waits for the device (synchronisations and copies that block) it is lost: that wait
/// and what follows return `error`, and kernels are not launched any more.
void loseDevice(cudaError_t error, std::size_t passing = 0);
/// Asking for the number of devices returns `error`.
void failDeviceCount(cudaError_t error);
/// Undoes all of these.
void stopFailing();

}  // namespace shallow_sand
