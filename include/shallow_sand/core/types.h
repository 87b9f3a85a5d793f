#pragma once

/// Functions marked so compile for the CPU and, under nvcc, for the GPU: one source, the same bits.
#ifdef __CUDACC__
#define SHALLOW_SAND_HOST_DEVICE __host__ __device__
#else
#define SHALLOW_SAND_HOST_DEVICE
#endif

namespace shallow_sand {

/// Three plain floats, for kernels; host code outside of them uses Eigen.
struct Vector3 {
  float x = 0.0f;
  float y = 0.0f;
  float z = 0.0f;
};

SHALLOW_SAND_HOST_DEVICE inline float minimum(float a, float b) { return a < b ? a : b; }
SHALLOW_SAND_HOST_DEVICE inline float maximum(float a, float b) { return a > b ? a : b; }

}  // namespace shallow_sand
