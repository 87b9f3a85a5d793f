#pragma once

#include "shallow_sand/core/types.h"

/// What several threads may do to one number at once, on either backend; in an order that does not matter.
namespace shallow_sand {

/// `value` becomes `other` if that is larger.
SHALLOW_SAND_HOST_DEVICE inline void atomicRaise(unsigned long long* value, unsigned long long other) {
#ifdef __CUDA_ARCH__
  atomicMax(value, other);
#else
  unsigned long long now = __atomic_load_n(value, __ATOMIC_RELAXED);
  while (now < other &&
         !__atomic_compare_exchange_n(value, &now, other, true, __ATOMIC_RELAXED, __ATOMIC_RELAXED)) {
  }
#endif
}

/// Sets `value` to 1. Returns whether it was 0 before.
SHALLOW_SAND_HOST_DEVICE inline bool atomicTake(int* value) {
#ifdef __CUDA_ARCH__
  return *static_cast<volatile int*>(value) == 0 && atomicExch(value, 1) == 0;
#else
  return __atomic_load_n(value, __ATOMIC_RELAXED) == 0 &&
         __atomic_exchange_n(value, 1, __ATOMIC_RELAXED) == 0;
#endif
}

/// Adds 1. Returns what was there before.
SHALLOW_SAND_HOST_DEVICE inline int atomicCount(int* value) {
#ifdef __CUDA_ARCH__
  return atomicAdd(value, 1);
#else
  return __atomic_fetch_add(value, 1, __ATOMIC_RELAXED);
#endif
}

}  // namespace shallow_sand
