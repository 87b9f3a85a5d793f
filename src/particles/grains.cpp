#include "shallow_sand/particles/grains.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace shallow_sand {

namespace {

/// The sand that one sees from above, between centres of cells (Eq. 27).
class SeenSand {
 public:
  SeenSand(const Grid& grid, const Fields& fields)
      : grid_(grid), surface_(grid.cells()), depth_(grid.cells()) {
    for (std::size_t k = 0; k < grid.cells(); ++k) {
      surface_[k] = fields.surface(k);
      depth_[k] = fields.hasLoad(k) ? fields.load[k] : fields.depth[k];
      hidden_.push_back(fields.allDepth(k) < bareDepth(grid));
    }
  }

  /// At a place, in cells from the corner of cell (0, 0).
  struct At {
    bool hidden;
    float surface;  ///< elevation [m]
    float depth;    ///< [m]
  };
  At operator()(float x, float y) const {
    const int i = std::min(static_cast<int>(x), grid_.columns - 1);
    const int j = std::min(static_cast<int>(y), grid_.rows - 1);
    const std::size_t own = grid_.index(i, j);
    if (hidden_[own]) return {true, 0.0f, 0.0f};
    const float east = x - static_cast<float>(i) - 0.5f;
    const float north = y - static_cast<float>(j) - 0.5f;
    const int beside = std::clamp(east < 0.0f ? i - 1 : i + 1, 0, grid_.columns - 1);
    const int above = std::clamp(north < 0.0f ? j - 1 : j + 1, 0, grid_.rows - 1);
    const std::array<std::size_t, 4> cells{own, near(own, grid_.index(beside, j)),
                                           near(own, grid_.index(i, above)),
                                           near(own, grid_.index(beside, above))};
    const float a = std::abs(east);
    const float b = std::abs(north);
    const std::array<float, 4> weights{(1.0f - a) * (1.0f - b), a * (1.0f - b), (1.0f - a) * b, a * b};
    At at{false, 0.0f, 0.0f};
    for (std::size_t k = 0; k < cells.size(); ++k) {
      at.surface += weights[k] * surface_[cells[k]];
      at.depth += weights[k] * depth_[cells[k]];
    }
    return at;
  }

 private:
  /// The other cell, unless between the two the surface breaks off, as at the edge of a bucket.
  std::size_t near(std::size_t own, std::size_t other) const {
    return std::abs(surface_[other] - surface_[own]) > kSteepest * grid_.spacing ? own : other;
  }

  Grid grid_;
  std::vector<float> surface_;
  std::vector<float> depth_;
  std::vector<bool> hidden_;
};

using Color = Eigen::Vector3f;

/// Sands that are told from each other at a glance.
const std::array<Color, 4> kTones{Color(0.96f, 0.86f, 0.64f), Color(0.80f, 0.50f, 0.29f),
                                  Color(0.56f, 0.36f, 0.23f), Color(0.90f, 0.70f, 0.42f)};
/// What came where there was no sand.
const Color kCame(0.93f, 0.78f, 0.54f);

/// Of squares, eight along the shorter side of the map.
Color toneOfOrigin(const GrainGrid& grid, std::uint32_t origin) {
  const int layer = static_cast<int>(origin % static_cast<std::uint32_t>(grid.columns * grid.rows));
  const int side = std::max(1, std::min(grid.columns, grid.rows) / 8);
  const int i = layer % grid.columns / side;
  const int j = layer / grid.columns / side;
  return kTones[static_cast<std::size_t>(2 * (j % 2) + (i + j / 2) % 2)];
}

/// Of eight strata, or of as many as there are layers.
Color toneOfLayer(const GrainGrid& grid, int layer) {
  const int strata = std::min(grid.layers, 8);
  return kTones[static_cast<std::size_t>(layer * strata / grid.layers) % kTones.size()];
}

Color colorOf(const Grains& grains, const Grain& grain, int layer) {
  // Bits that z_p does not come from.
  const float spot = static_cast<float>(bitsOf(grain) & 0xFFFF) / 65535.0f;
  const float bright = 0.90f + 0.16f * spot;
  const bool by_layer = grains.color == GrainColor::layer;
  const Color tone = by_layer         ? toneOfLayer(grains.grid, layer)
                     : grain.isBare() ? kCame
                                      : toneOfOrigin(grains.grid, grain.origin);
  return (bright * tone).cwiseMin(1.0f);
}

}  // namespace

GrainCloud grainCloud(const Grid& grid, const Fields& fields, const Grains& grains) {
  GrainCloud cloud;
  cloud.spacing = grains.grid.spacing;
  if (grains.cells.empty()) return cloud;
  const SeenSand sand(grid, fields);
  const float per_cell = static_cast<float>(grains.grid.per_cell);
  const double spacing = static_cast<double>(grains.grid.spacing);
  const Grain* next = grains.cells.data();
  for (int d = 0; d < grains.grid.layers; ++d) {
    for (int t = 0; t < grains.grid.rows; ++t) {
      for (int s = 0; s < grains.grid.columns; ++s) {
        const Grain& grain = *next++;
        const SeenSand::At at =
            sand((static_cast<float>(s) + grain.x) / per_cell, (static_cast<float>(t) + grain.y) / per_cell);
        if (at.hidden) continue;
        const float below = depthOf(grain, d, grains.grid.spacing);
        if (below > at.depth) continue;
        const double x = s + static_cast<double>(grain.x);
        const double y = t + static_cast<double>(grain.y);
        cloud.points.push_back(Eigen::Vector3d(grid.origin_x + spacing * x, grid.origin_y + spacing * y,
                                               static_cast<double>(at.surface - below))
                                   .cast<float>());
        cloud.colors.push_back(colorOf(grains, grain, d));
      }
    }
  }
  return cloud;
}

}  // namespace shallow_sand
