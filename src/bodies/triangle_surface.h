#pragma once

#include <Eigen/Geometry>
#include <array>
#include <memory>
#include <vector>

#include "shallow_sand/bodies/shape.h"
#include "shallow_sand/device/instruction_set.h"

namespace shallow_sand {

/// Most that a winding number of a TriangleSurface was found wrong by; see TriangleSurface::windingNumber.
constexpr double kWindingError = 0.1;

/// A mesh that can be asked, quickly and by many threads at once, how far away it is, how often it goes round
/// a point and what a ray meets. Triangles without area are left out.
class TriangleSurface {
 public:
  /// @param instructions one of instructionSets(); winding numbers are computed with up to AVX2 of it
  /// @throws InvalidParameter with key `mesh` for a mesh without area
  explicit TriangleSurface(const TriangleMesh& mesh, InstructionSet instructions = instructionSets().back());
  ~TriangleSurface();

  struct Nearest {
    double distance;  ///< [m]
    int triangle;     ///< of several as near the one that faces the point most; -1: none nearer than asked
  };
  Nearest nearest(const Eigen::Vector3d& point, double bound) const;
  /// The point of a triangle that is nearest to `point`.
  Eigen::Vector3d footOn(int triangle, const Eigen::Vector3d& point) const;
  /// Of length 1.
  const Eigen::Vector3d& normal(int triangle) const;

  /// How often the surface goes round `point`, after Jacobson, Kavan and Sorkine-Hornung 2013.
  double windingNumber(const Eigen::Vector3d& point) const;
  /// The same for several points at once, of which there is at least one; it is quicker the nearer they lie
  /// together.
  std::vector<double> windingNumbers(std::vector<Eigen::Vector3d> points) const;
  /// The winding number changes no faster than this within `radius` of `middle`;
  /// infinite if an open edge comes into there. [1/m] A surface is seen under a solid angle whose gradient is
  /// an integral along its open edges, as a current's magnetic field is (Biot and Savart): none for a closed
  /// mesh, whose winding number is constant off its surface.
  double windingGradient(const Eigen::Vector3d& middle, double radius) const;
  /// Length of all edges that no other triangle shares. [m]
  double openEdges() const;

  /// Where a ray goes through a triangle.
  struct Crossing {
    double along;  ///< [m]
    int change;    ///< of the winding number: 1 where the ray comes from the triangle's outer side, else -1
  };
  /// Of a ray of this length, in order. `direction` is of length 1. A ray right through an edge meets both of
  /// its triangles: choose one that does not.
  std::vector<Crossing> crossings(const Eigen::Vector3d& from, const Eigen::Vector3d& direction,
                                  double length) const;

 private:
  struct Tree;
  std::unique_ptr<const Tree> tree_;
  InstructionSet instructions_;
};

}  // namespace shallow_sand
