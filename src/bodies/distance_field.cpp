#include "shallow_sand/bodies/distance_field.h"

#include <omp.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <sstream>
#include <string>

#include "missing_thickness.h"
#include "shallow_sand/core/parameters.h"
#include "triangle_surface.h"

namespace shallow_sand {
namespace {

constexpr int kMargin = 2;           ///< samples around the solid
constexpr double kExactReach = 2.0;  ///< distances up to this many spacings are exact
constexpr int kBlockSize = 16;       ///< samples along the edge of a block that one thread fills
constexpr double kMostSamples = 1 << 27;
constexpr double kFarthest = 1e6;  ///< of a vertex from the body's origin: floats hold squares of it [m]
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kProbes = 12;          ///< along each axis, of the winding number
constexpr double kDeep = 0.5;        ///< of the way to the surface
constexpr double kMostDrift = 0.05;  ///< of a winding number that stands for all of a block near the surface
constexpr double kDoubt = 0.2;       ///< a winding number that is farther from a whole one is in doubt

bool isDoubtful(double winding) { return std::abs(winding - std::round(winding)) > kDoubt; }

/// A box of samples.
struct Block {
  Eigen::Array3i first;
  Eigen::Array3i size;

  Eigen::Vector3d middle() const { return first.cast<double>() + (size.cast<double>() - 1.0) / 2.0; }
  Eigen::Vector3d halfDiagonal() const { return (size.cast<double>() - 1.0) / 2.0; }
  bool single() const { return size.maxCoeff() == 1; }
};

/// Consecutive samples of one axis.
struct Run {
  int first;
  int size;
};

/// Halves; of an odd number also the one in the middle. So the parts of a mirror image are mirror images.
std::vector<Run> cut(const Run& run) {
  const int half = run.size / 2;
  if (half == 0) return {run};
  if (run.size % 2 == 0) return {{run.first, half}, {run.first + half, half}};
  return {{run.first, half}, {run.first + half, 1}, {run.first + half + 1, half}};
}

/// Runs of kBlockSize to both sides of the one in the middle, which has one sample less; shorter at the ends.
std::vector<Run> cutAxis(int samples) {
  const int middle = samples / 2;
  const int reach = kBlockSize / 2 - 1;
  std::vector<Run> runs{{std::max(middle - reach, 0), std::min(2 * reach + 1, samples)}};
  for (int offset = reach + 1; offset <= middle; offset += kBlockSize) {
    const int size = std::min(kBlockSize, middle - offset + 1);
    runs.push_back({middle + offset, size});
    runs.push_back({middle - offset - size + 1, size});
  }
  return runs;
}

std::vector<Block> blocksFrom(const std::vector<Run>& along_x, const std::vector<Run>& along_y,
                              const std::vector<Run>& along_z) {
  std::vector<Block> blocks;
  for (const Run& z : along_z) {
    for (const Run& y : along_y) {
      for (const Run& x : along_x) blocks.push_back({{x.first, y.first, z.first}, {x.size, y.size, z.size}});
    }
  }
  return blocks;
}

std::vector<Block> cut(const Block& block) {
  return blocksFrom(cut(Run{block.first.x(), block.size.x()}), cut(Run{block.first.y(), block.size.y()}),
                    cut(Run{block.first.z(), block.size.z()}));
}

/// Fills a field block by block. Distance and winding number at a block's middle bound both everywhere in the
/// block; only where that does not settle them is it cut and looked at again, down to single samples.
class Sampler {
 public:
  Sampler(const TriangleSurface& surface, double least_thickness, DistanceField& field)
      : surface_(surface),
        least_thickness_(least_thickness),
        reach_(kExactReach * field.spacing + least_thickness / 2.0),
        middle_sample_(Eigen::Array3i(field.samples[0], field.samples[1], field.samples[2]) / 2),
        middle_(field.origin + field.spacing * middle_sample_.cast<double>().matrix()),
        field_(field) {}

  void fill(const Block& block) const { fill(block, kInfinity, std::nullopt); }
  /// Of the samples next to the surface, the share at which it was moved.
  double thickened() const {
    return near_ > 0 ? static_cast<double>(moved_) / static_cast<double>(near_) : 0.0;
  }

 private:
  static bool isInside(double winding) { return std::abs(winding) > 0.5; }

  /// `bound`: a length known to be no shorter than the distance at the block's middle [m].
  /// `winding`: a number that is right for all of the block, where there is one.
  void fill(const Block& block, double bound, std::optional<double> winding) const {
    const Eigen::Vector3d middle = position(block.middle());
    const TriangleSurface::Nearest nearest = surface_.nearest(middle, bound);
    if (block.single()) {
      storeSample(block, middle, nearest, winding ? *winding : surface_.windingNumber(middle));
      return;
    }
    const double radius = field_.spacing * block.halfDiagonal().norm();
    const bool near = nearest.distance - radius < reach_;
    if (!winding) winding = windingOfAll(middle, radius, nearest.distance, near);
    if (winding && !near) {
      storeBound(block, middle, nearest.distance, isInside(*winding));
      return;
    }
    const std::vector<Block> parts = cut(block);
    std::vector<Eigen::Vector3d> middles;
    for (const Block& part : parts) middles.push_back(position(part.middle()));
    // The last cut leaves single samples, which need a number each and lie together.
    std::vector<double> windings;
    if (!winding && block.size.maxCoeff() <= 3) windings = surface_.windingNumbers(middles);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      // The small excess keeps rounding from cutting off the true distance.
      const double way = (middles[i] - middle).norm() * (1.0 + 1e-9);
      fill(parts[i], nearest.distance * (1.0 + 1e-9) + way, windings.empty() ? winding : windings[i]);
    }
  }

  /// Of everything within `radius` of `middle`, if one winding number can tell the side and, near the
  /// surface, also how thick the solid is. A closed mesh has one off its surface. That of an open one
  /// changes, but it is a harmonic function there: it does not come from near a whole number to ½ within half
  /// the way to the surface, unless it is far from whole numbers beyond.
  std::optional<double> windingOfAll(const Eigen::Vector3d& middle, double radius, double distance,
                                     bool near) const {
    if (distance <= radius) return std::nullopt;
    const bool deep = !near && radius <= kDeep * distance;
    const double change = radius * surface_.windingGradient(middle, radius);
    if (!deep && change > (near ? kMostDrift : 0.5 - kWindingError)) return std::nullopt;
    const double winding = surface_.windingNumber(middle);
    const double off_half = std::abs(std::abs(winding) - 0.5);
    if (off_half >= kWindingError + change || (deep && off_half >= 0.5 - kDoubt)) return winding;
    return std::nullopt;
  }

  void storeSample(const Block& block, const Eigen::Vector3d& point, const TriangleSurface::Nearest& nearest,
                   double winding) const {
    double missing = 0.0;
    if (least_thickness_ > 0.0 && nearest.triangle >= 0 && nearest.distance < reach_) {
      missing = missingThickness(surface_, point, nearest, winding, least_thickness_);
      if (nearest.distance < field_.spacing) {
        ++near_;
        if (missing > 0.0) ++moved_;
      }
    } else if (!isInside(winding)) {
      missing = least_thickness_;
    }
    // Parts that overlap have faces inside of the body: there the distance is 0, and must not look like the
    // surface to a ray that runs along one. On the surface itself the winding number is about a half.
    const double least = std::abs(winding) > 0.75 ? 1e-6 * field_.spacing : 0.0;
    const double distance = isInside(winding) ? -std::max(nearest.distance, least) : nearest.distance;
    at(block.first.x(), block.first.y(), block.first.z()) = static_cast<float>(distance - missing / 2.0);
  }

  /// Nowhere does the distance change faster than the position does.
  void storeBound(const Block& block, const Eigen::Vector3d& middle, double distance, bool inside) const {
    const Eigen::Array3i end = block.first + block.size;
    for (int k = block.first.z(); k < end.z(); ++k) {
      for (int j = block.first.y(); j < end.y(); ++j) {
        for (int i = block.first.x(); i < end.x(); ++i) {
          const double length = distance - (position(Eigen::Vector3d(i, j, k)) - middle).norm();
          at(i, j, k) = static_cast<float>(inside ? -length : length - least_thickness_ / 2.0);
        }
      }
    }
  }

  /// Counted from the middle, so that mirrored samples lie at mirrored places in every bit.
  Eigen::Vector3d position(const Eigen::Vector3d& sample) const {
    return middle_ + field_.spacing * (sample - middle_sample_.cast<double>().matrix());
  }
  float& at(int i, int j, int k) const {
    const auto wide = [](int value) { return static_cast<std::size_t>(value); };
    return field_.distance[(wide(k) * wide(field_.samples[1]) + wide(j)) * wide(field_.samples[0]) + wide(i)];
  }

  const TriangleSurface& surface_;
  const double least_thickness_;
  const double reach_;  ///< distances up to this are exact [m]
  const Eigen::Array3i middle_sample_;
  const Eigen::Vector3d middle_;
  DistanceField& field_;
  mutable std::atomic<long long> near_{0};
  mutable std::atomic<long long> moved_{0};
};

void validate(const TriangleMesh& mesh, double spacing) {
  if (!std::isfinite(spacing) || spacing <= 0.0) {
    throw InvalidParameter("spacing", std::to_string(spacing), "a positive, finite length in metres");
  }
  if (mesh.triangles.empty()) throw InvalidParameter("mesh", "no triangles", "at least one");
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    if ((vertex.array().abs() <= kFarthest).all()) continue;
    std::ostringstream found;
    found << "a vertex at (" << vertex.x() << ", " << vertex.y() << ", " << vertex.z() << ")";
    throw InvalidParameter("mesh", found.str(), "metres, at most a million");
  }
  for (const std::array<int, 3>& triangle : mesh.triangles) {
    for (const int corner : triangle) {
      if (corner >= 0 && static_cast<std::size_t>(corner) < mesh.vertices.size()) continue;
      throw InvalidParameter("mesh", "a triangle with vertex " + std::to_string(corner),
                             "vertices from 0 to " + std::to_string(mesh.vertices.size() - 1));
    }
  }
}

Eigen::AlignedBox3d boundsOf(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d bounds;
  for (const Eigen::Vector3d& vertex : mesh.vertices) bounds.extend(vertex);
  return bounds;
}

/// A field round all vertices and what they grow by, its distances still to be filled in.
DistanceField emptyField(const Eigen::AlignedBox3d& bounds, const Sampling& sampling) {
  const double spacing = sampling.spacing;
  // An odd number of samples about the middle: a plate thinner than the spacing then has samples inside.
  const Eigen::Array3d to_each_side =
      ((bounds.sizes().array() + sampling.least_thickness) / (2.0 * spacing)).ceil() + kMargin;
  const Eigen::Array3d samples = 2.0 * to_each_side + 1.0;
  if (!(samples.prod() <= kMostSamples)) {
    throw InvalidParameter("spacing",
                           std::to_string(spacing) + " m, which takes " + std::to_string(samples.prod()) +
                               " samples of the body's distance field",
                           "a spacing that takes at most " + std::to_string(kMostSamples));
  }
  DistanceField field;
  for (std::size_t axis = 0; axis < 3; ++axis) field.samples[axis] = static_cast<int>(samples[axis]);
  field.spacing = spacing;
  field.origin = bounds.center() - spacing * to_each_side.matrix();
  field.distance.resize(static_cast<std::size_t>(samples.prod()));
  return field;
}

/// Share of the box whose winding number is in doubt, from kProbes³ places in it.
double doubtfulShare(const TriangleSurface& surface, const Eigen::AlignedBox3d& box) {
  int doubtful = 0;
#pragma omp parallel for reduction(+ : doubtful)
  for (int probe = 0; probe < kProbes * kProbes * kProbes; ++probe) {
    const Eigen::Array3d place(probe % kProbes, probe / kProbes % kProbes, probe / (kProbes * kProbes));
    const Eigen::Vector3d point =
        box.min() + box.sizes().cwiseProduct(((place + 0.5) / static_cast<double>(kProbes)).matrix());
    const double winding = surface.windingNumber(point);
    if (isDoubtful(winding)) ++doubtful;
  }
  return static_cast<double>(doubtful) / (kProbes * kProbes * kProbes);
}

}  // namespace

DistanceFieldView DistanceField::view(const float* data) const {
  return {data,
          samples[0],
          samples[1],
          samples[2],
          static_cast<float>(spacing),
          {static_cast<float>(origin.x()), static_cast<float>(origin.y()), static_cast<float>(origin.z())}};
}

SampledMesh sampleMesh(const TriangleMesh& mesh, const Sampling& sampling) {
  validate(mesh, sampling.spacing);
  SampledMesh sampled;
  const Eigen::AlignedBox3d bounds = boundsOf(mesh);
  sampled.field = emptyField(bounds, sampling);
  const DistanceField& field = sampled.field;
  const TriangleSurface surface(mesh);
  const Sampler sampler(surface, sampling.least_thickness, sampled.field);
  const std::vector<Block> blocks =
      blocksFrom(cutAxis(field.samples[0]), cutAxis(field.samples[1]), cutAxis(field.samples[2]));
  std::atomic<std::size_t> done{0};
  // Which blocks are near the surface is not known before: whoever is free takes the next.
#pragma omp parallel for schedule(dynamic)
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    sampler.fill(blocks[i]);
    const std::size_t filled = ++done;
    if (sampling.progress && omp_get_thread_num() == 0) {
      sampling.progress(static_cast<double>(filled) / static_cast<double>(blocks.size()));
    }
  }
  sampled.thickened = sampler.thickened();
  sampled.doubtful = doubtfulShare(surface, bounds);
  sampled.open_edges = surface.openEdges();
  return sampled;
}

DistanceField computeDistanceField(const TriangleMesh& mesh, double spacing) {
  return sampleMesh(mesh, {spacing, 0.0, {}}).field;
}

}  // namespace shallow_sand
