#include "benchmark/references.h"

namespace shallow_sand {

#ifdef __x86_64__
__attribute__((target_clones("avx512f", "avx2", "default")))
#endif
void copyFields(const SandFields& in, const SandFieldsOut& out, long long begin, long long end) {
  const float* __restrict depth = in.depth;
  const float* __restrict momentum_x = in.momentum_x;
  const float* __restrict momentum_y = in.momentum_y;
  const float* __restrict bed = in.bed;
  float* __restrict depth_out = out.depth;
  float* __restrict momentum_x_out = out.momentum_x;
  float* __restrict momentum_y_out = out.momentum_y;
#pragma GCC ivdep
  for (long long k = begin; k < end; ++k) {
    depth_out[k] = depth[k] + bed[k];
    momentum_x_out[k] = momentum_x[k] + 1.0f;  // a plain copy would be memcpy's, with other stores than ours
    momentum_y_out[k] = momentum_y[k] + 1.0f;
  }
}

}  // namespace shallow_sand
