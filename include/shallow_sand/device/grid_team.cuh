#pragma once

#include <cooperative_groups.h>
#include <cuda_runtime.h>

#include "shallow_sand/device/block_size.h"

namespace shallow_sand {

/// What the threads of a launch agree on; zeros before the launch.
struct Ballots {
  unsigned counted[3];
};

/// All threads of a cooperative launch. They do the same things in the same order: each of these functions is
/// called by all of them, or by none.
class GridTeam {
 public:
  __device__ explicit GridTeam(Ballots* ballots) : ballots_(ballots) {}

  /// What any thread wrote before, all may read afterwards.
  __device__ void wait() const { cooperative_groups::this_grid().sync(); }

  __device__ bool isFirst() const { return blockIdx.x == 0 && threadIdx.x == 0 && threadIdx.y == 0; }
  __device__ unsigned thread() const {
    return (blockIdx.x * kBlockRows + threadIdx.y) * kBlockColumns + threadIdx.x;
  }
  __device__ unsigned threads() const { return gridDim.x * kBlockThreads; }

  /// The largest value of any thread, at least 0. Waits. Floats that are not negative are ordered like their
  /// bits.
  __device__ float maximum(float value) {
    unsigned bits = __float_as_uint(value);
    for (int offset = 16; offset > 0; offset /= 2)
      bits = max(bits, __shfl_xor_sync(0xffffffffu, bits, offset));
    if (threadIdx.x == 0 && bits > 0) atomicMax(&ballots_->counted[vote_], bits);
    return __uint_as_float(counted());
  }
  /// The bits that are set for any thread. Waits.
  __device__ unsigned any(unsigned bits) {
    for (int offset = 16; offset > 0; offset /= 2) bits |= __shfl_xor_sync(0xffffffffu, bits, offset);
    if (threadIdx.x == 0 && bits != 0) atomicOr(&ballots_->counted[vote_], bits);
    return counted();
  }

 private:
  /// One vote after the other counts in another place: while one is read, the next may have begun, and the
  /// place of the one after that is cleared.
  __device__ unsigned counted() {
    const int next = vote_ == 2 ? 0 : vote_ + 1;
    if (isFirst()) ballots_->counted[next] = 0;
    wait();
    const unsigned result = *static_cast<volatile unsigned*>(&ballots_->counted[vote_]);
    vote_ = next;
    return result;
  }

  Ballots* ballots_;
  int vote_ = 0;
};

}  // namespace shallow_sand
