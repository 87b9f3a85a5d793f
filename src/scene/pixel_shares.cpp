#include "pixel_shares.h"

#include <algorithm>
#include <cmath>

namespace shallow_sand {
namespace {

PixelShare coveredBy(double low, double high, int pixels) {
  const double begin = std::max(0.0, low);
  const double end = std::min(static_cast<double>(pixels), high);
  const double first = std::floor(begin);
  const double last = std::ceil(end) - 1.0;
  if (last <= first) {
    return {static_cast<int>(first), 1, 1.0, 1.0};
  }
  return {static_cast<int>(first), static_cast<int>(last - first) + 1, first + 1.0 - begin, end - last};
}

PixelShare linearAt(double centre, int pixels) {
  const double before = std::floor(centre - 0.5);
  const int first = static_cast<int>(before);
  if (first < 0 || first + 1 >= pixels) {
    return {std::clamp(first, 0, pixels - 1), 1, 1.0, 1.0};
  }
  const double beyond = centre - 0.5 - before;
  return {first, 2, 1.0 - beyond, beyond};
}

}  // namespace

std::vector<PixelShare> pixelShares(int cells, double start, double step, int pixels) {
  constexpr double kCoincident = 1e-3;  // pixels that a cell may be off
  const double length = std::abs(step);
  const bool coincident =
      std::abs(length - 1.0) * cells < kCoincident && std::abs(start - std::round(start)) < kCoincident;
  std::vector<PixelShare> shares(static_cast<std::size_t>(cells));
  for (int k = 0; k < cells; ++k) {
    const double centre = start + (k + 0.5) * step;
    PixelShare& share = shares[static_cast<std::size_t>(k)];
    if (!(centre >= 0.0 && centre < pixels)) {
      continue;
    }
    if (coincident) {
      share = {static_cast<int>(centre), 1, 1.0, 1.0};
    } else if (length > 1.0) {
      share = coveredBy(centre - 0.5 * length, centre + 0.5 * length, pixels);
    } else {
      share = linearAt(centre, pixels);
    }
  }
  return shares;
}

}  // namespace shallow_sand
