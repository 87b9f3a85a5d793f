#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <vector>

#include "shallow_sand/bodies/distance_field_view.h"
#include "shallow_sand/bodies/shape.h"

namespace shallow_sand {

/// Signed distance to a body's surface, sampled on a regular grid in the body's frame; negative inside
/// (section 5).
struct DistanceField {
  std::array<int, 3> samples{0, 0, 0};  ///< along x, y, z; x fastest in `distance`
  double spacing = 0.0;                 ///< between samples [m]
  Eigen::Vector3d origin{0, 0, 0};      ///< position of sample (0, 0, 0) [m]
  std::vector<float> distance;          ///< [m]

  /// What kernels read; `data` is where `distance` lies on their backend.
  DistanceFieldView view(const float* data) const;
};

/// Samples the mesh at `spacing` [m] with a margin of at least two samples on every side, an odd number of
/// samples about its middle along each axis.
///
/// Magnitude: within two spacings of the surface the distance, exact to the rounding of a float; farther away
/// a lower bound on it, itself at least two spacings. A mesh that is its own mirror image across a plane of
/// the axes, through the origin, gives a field that is its own mirror image, to the rounding of a double
/// before it becomes a float. Sign: negative where the winding number is above ½ or below −½ (parts that are
/// inside out), so overlapping parts and small holes do no harm. It is taken from the first terms of a
/// series, found wrong by up to 0.1: only where a mesh is open, and the number passes through ½ off its
/// surface, can that move the zero. Triangles without area are left out. A wall thinner than the spacing may
/// fall between the samples. Runs on OpenMP's threads.
/// @throws InvalidParameter with key `mesh` for a mesh without area, a vertex farther than a million metres
/// or a triangle with a vertex that is not there; with key `spacing` if that is not positive and finite or
/// takes more than 2^27 samples
DistanceField computeDistanceField(const TriangleMesh& mesh, double spacing);

/// How to sample a mesh whose thin parts are to be made thicker.
struct Sampling {
  double spacing = 0.0;          ///< between samples [m]
  double least_thickness = 0.0;  ///< of the solid, measured across its surface [m]
  std::function<void(double)>
      progress;  ///< told now and then which share is done; may be empty, must not throw
};

/// A field, and what was found on the way.
struct SampledMesh {
  DistanceField field;
  double thickened = 0.0;   ///< share of the surface that was moved outwards
  double doubtful = 0.0;    ///< share of the box around the mesh whose winding number is 0.2 off a whole one
  double open_edges = 0.0;  ///< length of edges with a triangle on one side only [m]
};

/// As computeDistanceField; besides, where the solid is thinner than `least_thickness` its surface moves
/// outwards on both sides by half of what is missing. Sheets without a volume become plates. Thick parts keep
/// their surface: right-angled edges and all others above 55 degrees, too, while the edges of sheets, tips
/// and sharper edges are rounded off up to half of `least_thickness` outside. The margin is larger by that,
/// and lower bounds outside are smaller by that.
SampledMesh sampleMesh(const TriangleMesh& mesh, const Sampling& sampling);

}  // namespace shallow_sand
