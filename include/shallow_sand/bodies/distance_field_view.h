#pragma once

#include "shallow_sand/core/types.h"

namespace shallow_sand {

/// A signed distance field as kernels see it; plain pointers, the body's own frame. [m]
struct DistanceFieldView {
  const float* distance = nullptr;
  int samples_x = 0;
  int samples_y = 0;
  int samples_z = 0;
  float spacing = 0.0f;
  Vector3 origin;

  /// Trilinear interpolation; outside of the sampled box a length of one spacing, which is outside of the
  /// body.
  SHALLOW_SAND_HOST_DEVICE float sample(Vector3 p) const {
    return sampleAt((p.x - origin.x) / spacing, (p.y - origin.y) / spacing, (p.z - origin.z) / spacing);
  }

  /// The same for a place that is counted in samples, from the first one on.
  SHALLOW_SAND_HOST_DEVICE float sampleAt(float x, float y, float z) const {
    if (!(x >= 0.0f && y >= 0.0f && z >= 0.0f && x < static_cast<float>(samples_x - 1) &&
          y < static_cast<float>(samples_y - 1) && z < static_cast<float>(samples_z - 1))) {
      return spacing;
    }
    const int i = static_cast<int>(x);
    const int j = static_cast<int>(y);
    const int k = static_cast<int>(z);
    const float s = x - static_cast<float>(i);
    const float t = y - static_cast<float>(j);
    const float low = interpolateLayer(i, j, k, s, t);
    const float high = interpolateLayer(i, j, k + 1, s, t);
    return low + (z - static_cast<float>(k)) * (high - low);
  }

 private:
  SHALLOW_SAND_HOST_DEVICE float interpolateLayer(int i, int j, int k, float s, float t) const {
    const float* row = distance + (static_cast<long long>(k) * samples_y + j) * samples_x + i;
    const float* next = row + samples_x;
    const float near = row[0] + s * (row[1] - row[0]);
    const float far = next[0] + s * (next[1] - next[0]);
    return near + t * (far - near);
  }
};

}  // namespace shallow_sand
