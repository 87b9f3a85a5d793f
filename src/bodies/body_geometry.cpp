#include "shallow_sand/bodies/body_geometry.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iomanip>
#include <sstream>

#include "field_cache.h"

namespace shallow_sand {
namespace {

constexpr double kMostSamples = 1 << 24;
constexpr double kMargin = 5.0;  ///< samples around the mesh, at most, for what it grows by
constexpr double kWorthTelling = 0.01;
/// In cells, or in two spacings where these are larger. The distance has a kink in the middle of a sheet, and
/// interpolation moves the zero towards it where both lie in one cube of samples: with the zero k spacings
/// off the kink and corners at −a and √3 − a spacings from it, by 2a(√3 − k − a)/(√3 − 2a). For k = 1.155
/// that is at most 0.155, and a whole cell is left.
constexpr double kSheetThickness = 1.155;

Eigen::Vector3d extentOf(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : mesh.vertices) box.extend(vertex);
  return box.isEmpty() ? Eigen::Vector3d(0.0, 0.0, 0.0) : Eigen::Vector3d(box.sizes());
}

double samplesOf(const Eigen::Vector3d& extent, double spacing) {
  return (extent.array() / spacing + 2.0 * kMargin + 1.0).prod();
}

std::string percent(double share) {
  std::ostringstream text;
  if (share < 0.01) {
    text << "less than 1 %";
  } else {
    text << std::lround(100.0 * share) << " %";
  }
  return text.str();
}

std::string metres(double length) {
  std::ostringstream text;
  text << std::setprecision(3) << length << " m";
  return text.str();
}

std::vector<std::string> notesOn(const SampledMesh& sampled, const Sampling& sampling, double sand_spacing) {
  std::vector<std::string> notes;
  if (sampling.spacing > 0.5 * sand_spacing * (1.0 + 1e-9)) {
    notes.push_back("so large that it is sampled every " + metres(sampling.spacing) +
                    " only, instead of every half cell (" + metres(0.5 * sand_spacing) + ")");
  }
  if (sampled.thickened > 0.0) {
    notes.push_back(percent(sampled.thickened) + " of its surface belong to parts thinner than " +
                    metres(sampling.least_thickness) + ", which are taken to be as thick as that");
  }
  if (sampled.doubtful >= kWorthTelling) {
    notes.push_back("its mesh leaves open what is inside: for " + percent(sampled.doubtful) +
                    " of the box around it the winding number is no whole number, and " +
                    metres(sampled.open_edges) +
                    " of edges are open; where the sand shows that, convex_hull or bounding_box help");
  }
  return notes;
}

}  // namespace

double distanceSpacing(const TriangleMesh& mesh, double sand_spacing) {
  const Eigen::Vector3d extent = extentOf(mesh);
  const double finest = std::max(extent.minCoeff(), sand_spacing) / 4.0;
  double spacing = std::min(sand_spacing / 2.0, finest);
  if (!extent.allFinite() || !(spacing > 0.0)) return spacing;  // which sampling refuses
  while (samplesOf(extent, spacing) > kMostSamples) spacing *= 1.1;
  return spacing;
}

BodyGeometry makeBodyGeometry(const TriangleMesh& mesh, double sand_spacing,
                              const BodyGeometryOptions& options) {
  const TriangleMesh solid = enclosingMesh(mesh, options.shape);
  Sampling sampling;
  sampling.spacing = distanceSpacing(solid, sand_spacing);
  sampling.least_thickness = kSheetThickness * std::max(sand_spacing, 2.0 * sampling.spacing);
  sampling.progress = options.progress;
  BodyGeometry geometry;
  SampledMesh sampled;
  std::string cache_problem;
  if (options.cache.empty()) {
    sampled = sampleMesh(solid, sampling);
  } else {
    const FieldCache cache(options.cache);
    const std::string key = cacheKey(solid, sampling);
    std::optional<SampledMesh> known = cache.load(key);
    geometry.from_cache = known.has_value();
    if (!known) {
      known = sampleMesh(solid, sampling);
      cache_problem = cache.store(key, *known);
    }
    sampled = std::move(*known);
  }
  geometry.notes = notesOn(sampled, sampling, sand_spacing);
  if (!cache_problem.empty()) {
    geometry.notes.push_back("its distance field is not kept for the next start: " + cache_problem);
  }
  geometry.field = std::make_shared<const DistanceField>(std::move(sampled.field));
  return geometry;
}

std::filesystem::path defaultCacheFolder() {
  const auto folder = [](const char* variable) {
    const char* value = std::getenv(variable);
    const std::filesystem::path path = value == nullptr ? "" : value;
    return path.is_absolute() ? path : std::filesystem::path();
  };
  const std::filesystem::path cache = folder("XDG_CACHE_HOME");
  if (!cache.empty()) return cache / "shallow_sand";
  const std::filesystem::path home = folder("HOME");
  return home.empty() ? home : home / ".cache" / "shallow_sand";
}

}  // namespace shallow_sand
