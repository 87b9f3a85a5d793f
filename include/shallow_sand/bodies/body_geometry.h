#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "shallow_sand/bodies/distance_field.h"
#include "shallow_sand/bodies/shape.h"

namespace shallow_sand {

/// What stands for a link or body in the sand.
enum class LinkShape {
  exact,        ///< its own triangles
  convex_hull,  ///< their convex hull
  bounding_box  ///< a box around them, along the frame's axes or turned, whichever is smaller
};

/// From `exact`, `convex_hull` or `bounding_box`.
/// @param key that the error names
/// @throws InvalidParameter for anything else
LinkShape linkShapeFromString(const std::string& name, const std::string& key);

/// The mesh, or what `shape` puts around it; closed and facing outwards then.
/// @throws InvalidParameter with key `mesh` where there is no such thing: a mesh without triangles, the hull
/// of a flat one
TriangleMesh enclosingMesh(const TriangleMesh& mesh, LinkShape shape);

struct BodyGeometryOptions {
  LinkShape shape = LinkShape::exact;
  std::filesystem::path cache;  ///< folder that keeps fields for the next time; empty: nothing is kept
  std::function<void(double)>
      progress;  ///< told now and then which share is done; may be empty, must not throw
};

/// A body that is ready for the simulator.
struct BodyGeometry {
  std::shared_ptr<const DistanceField> field;
  std::vector<std::string> notes;  ///< what a user should know, one line each, fit for a log
  bool from_cache = false;
};

/// The distance field of a body on sand with cells of `sand_spacing` [m]. What is thinner than 1.16 cells is
/// made that thick (see sampleMesh), as sand meets bodies at the middles of its columns only: between its
/// samples the field then is a cell thick at least. A body too large
/// for 2^24 samples is sampled more coarsely, and thickened accordingly.
/// @throws InvalidParameter with key `mesh` or `spacing` for what cannot be sampled
BodyGeometry makeBodyGeometry(const TriangleMesh& mesh, double sand_spacing,
                              const BodyGeometryOptions& options = {});

/// Distance between samples [m] of a body's distance field on sand of `sand_spacing` [m]: half of a cell,
/// less for bodies thinner than two cells, but not below a quarter of a cell; more where that would take more
/// than 2^24 samples.
double distanceSpacing(const TriangleMesh& mesh, double sand_spacing);

/// Where fields are kept: $XDG_CACHE_HOME/shallow_sand, or ~/.cache/shallow_sand; empty without both.
std::filesystem::path defaultCacheFolder();

}  // namespace shallow_sand
