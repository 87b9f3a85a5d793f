#include "shallow_sand/coupling/rays_alone.h"
#include "shallow_sand/device/cuda_executor.cuh"
#include "shallow_sand/sim/engine_on.h"
#include "shallow_sand/solver/grid_stepper.h"

namespace shallow_sand {

std::unique_ptr<Engine> makeCudaEngine(const EngineStart& start) {
  return std::make_unique<EngineOn<CudaExecutor, RaysAlone, GridStepper<CudaExecutor>>>(
      CudaExecutor(), RaysAlone(), start, start.with_slopes);
}

std::string cudaUnavailable() {
  int devices = 0;
  const cudaError_t status = cudaGetDeviceCount(&devices);
  if (status != cudaSuccess) return cudaGetErrorString(status);
  if (devices == 0) return "no CUDA-capable device is detected";
  // A GPU older than those that the kernels were compiled for is found out here, not at the first launch.
  cudaFuncAttributes attributes{};
  const cudaError_t kernel = cudaFuncGetAttributes(&attributes, maximumKernel<StepCell<Step<false, false>>>);
  return kernel == cudaSuccess ? "" : cudaGetErrorString(kernel);
}

std::string cudaDeviceName() {
  cudaDeviceProp properties{};
  checkCuda(cudaGetDeviceProperties(&properties, 0), "read the device's name");
  return properties.name;
}

}  // namespace shallow_sand
