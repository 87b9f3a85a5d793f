#include "cuda_calls.h"

#include <cxxabi.h>
#include <dlfcn.h>

#include <cstdlib>
#include <iostream>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>

namespace shallow_sand {
namespace {

struct FullDevice {
  std::size_t at_least;
  std::size_t passing;
};

struct LostDevice {
  cudaError_t error;
  std::size_t passing;
};

struct Calls {
  std::mutex mutex;
  std::map<const void*, std::string> kernels;  // by the address that stands for them on the host
  std::map<const void*, const void*> handles;  // of the runtime, to that address
  std::set<const void*> launched;              // those addresses
  std::size_t launches = 0;
  std::size_t allocations = 0;
  std::set<const void*> held;
  std::optional<FullDevice> full;
  std::optional<LostDevice> to_lose;
  cudaError_t lost = cudaSuccess;
  cudaError_t device_count = cudaSuccess;
};

/// The calls, while nobody else changes them.
class LockedCalls {
 public:
  explicit LockedCalls(Calls& calls) : calls_(calls), lock_(calls.mutex) {}
  Calls* operator->() const { return &calls_; }

 private:
  Calls& calls_;
  std::unique_lock<std::mutex> lock_;
};

LockedCalls locked() {
  // Never destroyed: libraries register kernels before, and free memory after, objects of this program live.
  static Calls* const calls = new Calls;
  return LockedCalls(*calls);
}

std::string demangled(const char* name) {
  int status = 0;
  const std::unique_ptr<char, void (*)(void*)> text(abi::__cxa_demangle(name, nullptr, nullptr, &status),
                                                    std::free);
  return status == 0 ? text.get() : name;
}

/// The runtime's own function of that name.
template <class Function>
Function following(const char* name) {
  void* const found = dlsym(RTLD_NEXT, name);
  if (found == nullptr) {
    std::cerr << "the CUDA runtime has no " << name << std::endl;
    std::abort();
  }
  return reinterpret_cast<Function>(found);
}

/// What `status` becomes if the device is lost.
cudaError_t unlessLost(cudaError_t status) {
  const cudaError_t lost = locked()->lost;
  return lost != cudaSuccess ? lost : status;
}

/// Whether an allocation finds the device full.
bool findsDeviceFull(std::size_t size) {
  const LockedCalls all = locked();
  ++all->allocations;
  if (!all->full) return false;
  if (all->full->passing == 0) return size >= all->full->at_least;
  --all->full->passing;
  return false;
}

template <class Next>
cudaError_t allocate(void** pointer, std::size_t size, const Next& next) {
  if (findsDeviceFull(size)) {
    // The runtime is asked for more than there is, so that it remembers the error as it would.
    next(std::size_t{1} << 60);
    return cudaErrorMemoryAllocation;
  }
  const cudaError_t lost = unlessLost(cudaSuccess);
  const cudaError_t status = lost != cudaSuccess ? lost : next(size);
  if (status == cudaSuccess) locked()->held.insert(*pointer);
  return status;
}

template <class Next>
cudaError_t release(void* pointer, const Next& next) {
  locked()->held.erase(pointer);
  return unlessLost(next(pointer));
}

template <class Next>
cudaError_t wait(const Next& next) {
  const cudaError_t status = next();
  {
    const LockedCalls all = locked();
    if (all->to_lose && all->to_lose->passing > 0) {
      --all->to_lose->passing;
    } else if (all->to_lose) {
      all->lost = all->to_lose->error;
    }
  }
  return unlessLost(status);
}

/// `kernel` is the address that stands for it on the host, or a handle of the runtime.
template <class Next>
cudaError_t launch(const void* kernel, const Next& next) {
  {
    const LockedCalls all = locked();
    if (all->lost != cudaSuccess) return all->lost;
    ++all->launches;
    const auto handle = all->handles.find(kernel);
    all->launched.insert(handle == all->handles.end() ? kernel : handle->second);
  }
  return next();
}

}  // namespace

std::vector<std::string> kernelsNeverLaunched() {
  const LockedCalls all = locked();
  std::vector<std::string> never;
  for (const auto& kernel : all->kernels) {
    if (all->launched.count(kernel.first) == 0) never.push_back(kernel.second);
  }
  return never;
}

std::size_t launches() { return locked()->launches; }

std::size_t allocations() { return locked()->allocations; }

std::size_t allocationsHeld() { return locked()->held.size(); }

std::string toldByRuntime(cudaError_t error) {
  return following<decltype(&cudaGetErrorString)>("cudaGetErrorString")(error);
}

void failAllocations(std::size_t at_least, std::size_t passing) {
  locked()->full = FullDevice{at_least, passing};
}

void loseDevice(cudaError_t error, std::size_t passing) { locked()->to_lose = LostDevice{error, passing}; }

void failDeviceCount(cudaError_t error) { locked()->device_count = error; }

void stopFailing() {
  const LockedCalls all = locked();
  all->full.reset();
  all->to_lose.reset();
  all->lost = cudaSuccess;
  all->device_count = cudaSuccess;
}

}  // namespace shallow_sand

using namespace shallow_sand;

extern "C" {

// Code that nvcc generates calls these three, which no header declares for programs. A handle is a
// cudaKernel_t, which CUDA 11 does not have.
void __cudaRegisterFunction(void** binary, const char* on_host, char* on_device, const char* name,
                            int threads, uint3* thread, uint3* block, dim3* block_size, dim3* grid_size,
                            int* warp_size) {
  locked()->kernels[on_host] = demangled(name);
  static const auto next = following<decltype(&__cudaRegisterFunction)>("__cudaRegisterFunction");
  next(binary, on_host, on_device, name, threads, thread, block, block_size, grid_size, warp_size);
}

cudaError_t __cudaGetKernel(void** handle, const void* on_host) {
  static const auto next = following<decltype(&__cudaGetKernel)>("__cudaGetKernel");
  const cudaError_t status = next(handle, on_host);
  if (status == cudaSuccess) locked()->handles[*handle] = on_host;
  return status;
}

cudaError_t __cudaLaunchKernel(void* handle, dim3 grid, dim3 block, void** arguments, std::size_t shared,
                               cudaStream_t stream) {
  static const auto next = following<decltype(&__cudaLaunchKernel)>("__cudaLaunchKernel");
  return launch(handle, [&] { return next(handle, grid, block, arguments, shared, stream); });
}

cudaError_t cudaLaunchKernel(const void* kernel, dim3 grid, dim3 block, void** arguments, std::size_t shared,
                             cudaStream_t stream) {
  static const auto next = following<decltype(&cudaLaunchKernel)>("cudaLaunchKernel");
  return launch(kernel, [&] { return next(kernel, grid, block, arguments, shared, stream); });
}

cudaError_t cudaLaunchCooperativeKernel(const void* kernel, dim3 grid, dim3 block, void** arguments,
                                        std::size_t shared, cudaStream_t stream) {
  static const auto next = following<decltype(&cudaLaunchCooperativeKernel)>("cudaLaunchCooperativeKernel");
  return launch(kernel, [&] { return next(kernel, grid, block, arguments, shared, stream); });
}

#if CUDART_VERSION >= 11080
cudaError_t cudaLaunchKernelExC(const cudaLaunchConfig_t* configuration, const void* kernel,
                                void** arguments) {
  static const auto next = following<decltype(&cudaLaunchKernelExC)>("cudaLaunchKernelExC");
  return launch(kernel, [&] { return next(configuration, kernel, arguments); });
}
#endif

cudaError_t cudaGetLastError() {
  static const auto next = following<decltype(&cudaGetLastError)>("cudaGetLastError");
  return unlessLost(next());
}

cudaError_t cudaPeekAtLastError() {
  static const auto next = following<decltype(&cudaPeekAtLastError)>("cudaPeekAtLastError");
  return unlessLost(next());
}

cudaError_t cudaMalloc(void** pointer, std::size_t size) {
  static const auto next = following<decltype(&cudaMalloc)>("cudaMalloc");
  return allocate(pointer, size, [&](std::size_t bytes) { return next(pointer, bytes); });
}

cudaError_t cudaMallocHost(void** pointer, std::size_t size) {
  static const auto next = following<decltype(&cudaMallocHost)>("cudaMallocHost");
  return allocate(pointer, size, [&](std::size_t bytes) { return next(pointer, bytes); });
}

cudaError_t cudaHostAlloc(void** pointer, std::size_t size, unsigned int flags) {
  static const auto next = following<decltype(&cudaHostAlloc)>("cudaHostAlloc");
  return allocate(pointer, size, [&](std::size_t bytes) { return next(pointer, bytes, flags); });
}

cudaError_t cudaFree(void* pointer) {
  static const auto next = following<decltype(&cudaFree)>("cudaFree");
  return release(pointer, next);
}

cudaError_t cudaFreeHost(void* pointer) {
  static const auto next = following<decltype(&cudaFreeHost)>("cudaFreeHost");
  return release(pointer, next);
}

#if CUDART_VERSION >= 11020
cudaError_t cudaMallocAsync(void** pointer, std::size_t size, cudaStream_t stream) {
  static const auto next = following<decltype(&cudaMallocAsync)>("cudaMallocAsync");
  return allocate(pointer, size, [&](std::size_t bytes) { return next(pointer, bytes, stream); });
}

cudaError_t cudaFreeAsync(void* pointer, cudaStream_t stream) {
  static const auto next = following<decltype(&cudaFreeAsync)>("cudaFreeAsync");
  return release(pointer, [&](void* freed) { return next(freed, stream); });
}
#endif

cudaError_t cudaDeviceSynchronize() {
  static const auto next = following<decltype(&cudaDeviceSynchronize)>("cudaDeviceSynchronize");
  return wait(next);
}

cudaError_t cudaStreamSynchronize(cudaStream_t stream) {
  static const auto next = following<decltype(&cudaStreamSynchronize)>("cudaStreamSynchronize");
  return wait([&] { return next(stream); });
}

cudaError_t cudaEventSynchronize(cudaEvent_t event) {
  static const auto next = following<decltype(&cudaEventSynchronize)>("cudaEventSynchronize");
  return wait([&] { return next(event); });
}

cudaError_t cudaMemcpy(void* to, const void* from, std::size_t size, cudaMemcpyKind kind) {
  static const auto next = following<decltype(&cudaMemcpy)>("cudaMemcpy");
  return wait([&] { return next(to, from, size, kind); });
}

cudaError_t cudaGetDeviceCount(int* count) {
  static const auto next = following<decltype(&cudaGetDeviceCount)>("cudaGetDeviceCount");
  const cudaError_t failure = locked()->device_count;
  return failure != cudaSuccess ? failure : next(count);
}
}
