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
    return covers(x, y, z) ? interpolateAt(x, y, z) : spacing;
  }

  /// Whether such a place is within the sampled box. Without branches, so that a compiler looks at several
  /// places at once.
  SHALLOW_SAND_HOST_DEVICE bool covers(float x, float y, float z) const {
    return (x >= 0.0f) & (y >= 0.0f) & (z >= 0.0f) & (x < static_cast<float>(samples_x - 1)) &
           (y < static_cast<float>(samples_y - 1)) & (z < static_cast<float>(samples_z - 1));
  }

  /// Trilinear interpolation at such a place; of no meaning, but allowed, outside of the box.
  SHALLOW_SAND_HOST_DEVICE float interpolateAt(float x, float y, float z) const {
    const int i = sampleBelow(x, samples_x);
    const int j = sampleBelow(y, samples_y);
    const int k = sampleBelow(z, samples_z);
    const float s = x - static_cast<float>(i);
    const float t = y - static_cast<float>(j);
    const float low = interpolateLayer(i, j, k, s, t);
    const float high = interpolateLayer(i, j, k + 1, s, t);
    return low + (z - static_cast<float>(k)) * (high - low);
  }

 private:
  /// The sample before a place; the nearest one that has another behind it, if the place is outside.
  SHALLOW_SAND_HOST_DEVICE static int sampleBelow(float place, int samples) {
    return static_cast<int>(minimum(maximum(place, 0.0f), static_cast<float>(samples - 2)));
  }
  SHALLOW_SAND_HOST_DEVICE float interpolateLayer(int i, int j, int k, float s, float t) const {
    const int at = (k * samples_y + j) * samples_x + i;
    const int next = at + samples_x;
    const float near = distance[at] + s * (distance[at + 1] - distance[at]);
    const float far = distance[next] + s * (distance[next + 1] - distance[next]);
    return near + t * (far - near);
  }
};

}  // namespace shallow_sand
