#include "triangle_surface.h"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/math/bv/AABB.h>
#include <fcl/math/detail/project.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "shallow_sand/core/parameters.h"

namespace shallow_sand {
namespace {

constexpr double kPi = 3.14159265358979323846;
/// A node is seen as a series from this many of its radii on. There the series was found wrong by up to 0.05
/// on a sphere, 0.04 on a bowl, 0.1 on four spheres in one another, 0.006 on loose triangles; three radii
/// halve that and cost more.
constexpr double kFarInRadii = 2.0;
constexpr double kTie = 1e-12;  ///< relative; squared distances that differ by less are the same

using Model = fcl::BVHModel<fcl::AABB<double>>;
using Project = fcl::detail::Project<double>;

/// What a far point sees of all triangles below a node: Barill, Dickson, Schmidt, Levin and Jacobson 2018,
/// "Fast winding numbers for soups and clouds", with their first two terms.
struct Moments {
  double area = 0.0;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();       ///< weighted by area
  Eigen::Vector3d area_vector = Eigen::Vector3d::Zero();  ///< Σ area·normal
  Eigen::Matrix3d first = Eigen::Matrix3d::Zero();  ///< Σ (triangle's centre − centre)·(area·normal)ᵀ
  double radius = 0.0;                              ///< no part of the surface is farther from `centre`

  double solidAngle(const Eigen::Vector3d& point) const {
    const Eigen::Vector3d away = centre - point;
    const double inverse = 1.0 / away.squaredNorm();
    const double inverse_cubed = inverse * std::sqrt(inverse);
    return inverse_cubed * (area_vector.dot(away) + first.trace() - 3.0 * inverse * away.dot(first * away));
  }
};

using Corners = std::array<Eigen::Vector3d, 3>;

/// A sum of angles as the angle of a product of complex numbers, which is quicker than an arc tangent each.
class AngleSum {
 public:
  /// Adds the angle of a + ib, from −π to π.
  void add(double a, double b) {
    const double product_real = real_ * a - imaginary_ * b;
    const double product_imaginary = real_ * b + imaginary_ * a;
    // Two angles of one half plane whose sum lies in the other one went past π.
    if (imaginary_ >= 0.0 && b >= 0.0 && product_imaginary < 0.0) ++turns_;
    if (imaginary_ < 0.0 && b < 0.0 && product_imaginary >= 0.0) --turns_;
    const double size = std::abs(product_real) + std::abs(product_imaginary);
    if (size > 1e-100 && size < 1e100) {
      real_ = product_real;
      imaginary_ = product_imaginary;
    } else if (size > 0.0) {
      real_ = product_real / size;
      imaginary_ = product_imaginary / size;
    }
  }
  double sum() const { return std::atan2(imaginary_, real_) + 2.0 * kPi * turns_; }

 private:
  double real_ = 1.0;
  double imaginary_ = 0.0;
  int turns_ = 0;
};

/// Adds half the solid angle of a triangle: Van Oosterom and Strackee 1983. Positive when `point` is behind
/// it.
void addSolidAngle(const Corners& triangle, const Eigen::Vector3d& point, AngleSum& halves) {
  const Eigen::Vector3d a = triangle[0] - point;
  const Eigen::Vector3d b = triangle[1] - point;
  const Eigen::Vector3d c = triangle[2] - point;
  const double a_length = a.norm();
  const double b_length = b.norm();
  const double c_length = c.norm();
  halves.add(a_length * b_length * c_length + a.dot(b) * c_length + b.dot(c) * a_length + c.dot(a) * b_length,
             a.dot(b.cross(c)));
}

bool hasArea(const TriangleMesh& mesh, const std::array<int, 3>& triangle) {
  const Eigen::Vector3d& a = mesh.vertices[static_cast<std::size_t>(triangle[0])];
  const Eigen::Vector3d u = mesh.vertices[static_cast<std::size_t>(triangle[1])] - a;
  const Eigen::Vector3d v = mesh.vertices[static_cast<std::size_t>(triangle[2])] - a;
  // Below this its normal is noise, and so would be a distance to its plane; its edges belong to its
  // neighbours.
  return u.cross(v).norm() > 1e-10 * std::max({u.squaredNorm(), v.squaredNorm(), (u - v).squaredNorm()});
}

/// Edges at the same place cancel when they run in opposite directions.
double lengthOfOpenEdges(const Model& model) {
  using Edge = std::array<double, 6>;
  std::vector<std::pair<Edge, int>> edges;
  edges.reserve(3 * static_cast<std::size_t>(model.num_tris));
  for (int i = 0; i < model.num_tris; ++i) {
    for (int corner = 0; corner < 3; ++corner) {
      const Eigen::Vector3d& from = model.vertices[model.tri_indices[i][corner]];
      const Eigen::Vector3d& to = model.vertices[model.tri_indices[i][(corner + 1) % 3]];
      const Edge there{from.x(), from.y(), from.z(), to.x(), to.y(), to.z()};
      const Edge back{to.x(), to.y(), to.z(), from.x(), from.y(), from.z()};
      edges.push_back({std::min(there, back), there < back ? 1 : -1});
    }
  }
  std::sort(edges.begin(), edges.end());
  double length = 0.0;
  for (auto first = edges.begin(); first != edges.end();) {
    const Edge edge = first->first;
    int count = 0;
    for (; first != edges.end() && first->first == edge; ++first) count += first->second;
    length +=
        std::abs(count) * Eigen::Vector3d(edge[3] - edge[0], edge[4] - edge[1], edge[5] - edge[2]).norm();
  }
  return length;
}

}  // namespace

/// The mesh in FCL's bounding volume hierarchy. fcl::distance itself is of no use here: for a point it goes
/// through Sphere and Triangle, which leave the distance unset where they touch (FCL 0.7,
/// sphere_triangle-inl.h). So this walks FCL's tree and projects on triangles with FCL's Project.
struct TriangleSurface::Tree {
  explicit Tree(const TriangleMesh& mesh);
  void gatherMoments(int node);

  Corners corners(int triangle) const {
    const fcl::Triangle& indices = model.tri_indices[triangle];
    return {model.vertices[indices[0]], model.vertices[indices[1]], model.vertices[indices[2]]};
  }
  const Moments& at(int node) const { return moments[static_cast<std::size_t>(node)]; }
  double squaredDistanceToBox(int node, const Eigen::Vector3d& point) const {
    const fcl::AABB<double>& box = model.getBV(node).bv;
    return (box.min_ - point).cwiseMax(point - box.max_).cwiseMax(0.0).squaredNorm();
  }

  struct Search {
    Eigen::Vector3d point;
    double squared;  ///< distance of the nearest so far [m²]
    int triangle = -1;
    double facing = -1.0;  ///< distance of the point from that triangle's plane [m]
  };
  void nearest(int node, Search& search) const;
  void compare(int triangle, Search& search) const;
  /// Of all triangles below `node`: of near ones into `halves`, of far ones as the result.
  double solidAngle(int node, const Eigen::Vector3d& point, AngleSum& halves) const;

  struct Ray {
    Eigen::Vector3d from;
    Eigen::Vector3d direction;
    double length;
  };
  bool meets(const Ray& ray, const fcl::AABB<double>& box) const;
  void cross(int node, const Ray& ray, std::vector<Crossing>& crossings) const;
  void crossTriangle(int triangle, const Ray& ray, std::vector<Crossing>& crossings) const;

  Model model;
  std::vector<Moments> moments;          ///< one a node
  std::vector<Eigen::Vector3d> normals;  ///< one a triangle
  double open_edges = 0.0;               ///< [m]
};

TriangleSurface::Tree::Tree(const TriangleMesh& mesh) {
  model.beginModel(static_cast<int>(mesh.triangles.size()), 3 * static_cast<int>(mesh.triangles.size()));
  for (const std::array<int, 3>& triangle : mesh.triangles) {
    if (!hasArea(mesh, triangle)) continue;
    model.addTriangle(mesh.vertices[static_cast<std::size_t>(triangle[0])],
                      mesh.vertices[static_cast<std::size_t>(triangle[1])],
                      mesh.vertices[static_cast<std::size_t>(triangle[2])]);
  }
  if (model.num_tris == 0) {
    throw InvalidParameter("mesh", "no triangle with an area", "at least one");
  }
  model.endModel();
  moments.resize(static_cast<std::size_t>(model.getNumBVs()));
  gatherMoments(0);
  for (int i = 0; i < model.num_tris; ++i) {
    const auto [a, b, c] = corners(i);
    normals.push_back((b - a).cross(c - a).normalized());
  }
  open_edges = lengthOfOpenEdges(model);
}

void TriangleSurface::Tree::gatherMoments(int node) {
  const auto& tree = model.getBV(node);
  Moments& sum = moments[static_cast<std::size_t>(node)];
  if (tree.isLeaf()) {
    const auto [a, b, c] = corners(tree.primitiveId());
    sum.area_vector = (b - a).cross(c - a) / 2.0;
    sum.area = sum.area_vector.norm();
    sum.centre = (a + b + c) / 3.0;
    sum.radius = std::max({(a - sum.centre).norm(), (b - sum.centre).norm(), (c - sum.centre).norm()});
  } else {
    gatherMoments(tree.leftChild());
    gatherMoments(tree.rightChild());
    const Moments& left = at(tree.leftChild());
    const Moments& right = at(tree.rightChild());
    sum.area = left.area + right.area;
    sum.centre = (left.area * left.centre + right.area * right.centre) / sum.area;
    sum.area_vector = left.area_vector + right.area_vector;
    sum.first = left.first + (left.centre - sum.centre) * left.area_vector.transpose() + right.first +
                (right.centre - sum.centre) * right.area_vector.transpose();
    const Eigen::Vector3d to_far_corner =
        (tree.bv.max_ - sum.centre).cwiseAbs().cwiseMax((tree.bv.min_ - sum.centre).cwiseAbs());
    sum.radius = std::min(to_far_corner.norm(), std::max(left.radius + (left.centre - sum.centre).norm(),
                                                         right.radius + (right.centre - sum.centre).norm()));
  }
}

void TriangleSurface::Tree::compare(int triangle, Search& search) const {
  const auto [a, b, c] = corners(triangle);
  const double squared = Project::projectTriangle(a, b, c, search.point).sqr_distance;
  if (squared > search.squared * (1.0 + kTie)) return;
  const double facing = std::abs(normals[static_cast<std::size_t>(triangle)].dot(search.point - a));
  if (squared < search.squared * (1.0 - kTie) || facing > search.facing) {
    search.triangle = triangle;
    search.facing = facing;
  }
  search.squared = std::min(search.squared, squared);
}

void TriangleSurface::Tree::nearest(int node, Search& search) const {
  const auto& tree = model.getBV(node);
  if (tree.isLeaf()) {
    compare(tree.primitiveId(), search);
    return;
  }
  int near = tree.leftChild();
  int far = tree.rightChild();
  double to_near = squaredDistanceToBox(near, search.point);
  double to_far = squaredDistanceToBox(far, search.point);
  if (to_far < to_near) {
    std::swap(near, far);
    std::swap(to_near, to_far);
  }
  if (to_near <= search.squared * (1.0 + kTie)) nearest(near, search);
  if (to_far <= search.squared * (1.0 + kTie)) nearest(far, search);
}

double TriangleSurface::Tree::solidAngle(int node, const Eigen::Vector3d& point, AngleSum& halves) const {
  const double far = kFarInRadii * at(node).radius;
  const auto& tree = model.getBV(node);
  if (tree.isLeaf()) {
    addSolidAngle(corners(tree.primitiveId()), point, halves);
    return 0.0;
  }
  if ((at(node).centre - point).squaredNorm() > far * far) return at(node).solidAngle(point);
  return solidAngle(tree.leftChild(), point, halves) + solidAngle(tree.rightChild(), point, halves);
}

bool TriangleSurface::Tree::meets(const Ray& ray, const fcl::AABB<double>& box) const {
  double enter = 0.0;
  double leave = ray.length;
  for (int axis = 0; axis < 3; ++axis) {
    if (ray.direction[axis] == 0.0) {
      if (ray.from[axis] < box.min_[axis] || ray.from[axis] > box.max_[axis]) return false;
      continue;
    }
    const double low = (box.min_[axis] - ray.from[axis]) / ray.direction[axis];
    const double high = (box.max_[axis] - ray.from[axis]) / ray.direction[axis];
    enter = std::max(enter, std::min(low, high));
    leave = std::min(leave, std::max(low, high));
  }
  return enter <= leave + 1e-9 * ray.length;
}

void TriangleSurface::Tree::crossTriangle(int triangle, const Ray& ray,
                                          std::vector<Crossing>& crossings) const {
  const auto [a, b, c] = corners(triangle);
  const double approach = -normals[static_cast<std::size_t>(triangle)].dot(ray.direction);
  if (std::abs(approach) < 1e-9) return;
  const double along = normals[static_cast<std::size_t>(triangle)].dot(ray.from - a) / approach;
  if (!(along >= 0.0 && along <= ray.length)) return;
  // On which side of each edge the ray passes: the signs of three volumes.
  const Eigen::Vector3d u = a - ray.from;
  const Eigen::Vector3d v = b - ray.from;
  const Eigen::Vector3d w = c - ray.from;
  const double first = ray.direction.dot(u.cross(v));
  const double second = ray.direction.dot(v.cross(w));
  const double third = ray.direction.dot(w.cross(u));
  const bool within =
      (first <= 0.0 && second <= 0.0 && third <= 0.0) || (first >= 0.0 && second >= 0.0 && third >= 0.0);
  if (within) crossings.push_back({along, approach > 0.0 ? 1 : -1});
}

void TriangleSurface::Tree::cross(int node, const Ray& ray, std::vector<Crossing>& crossings) const {
  const auto& tree = model.getBV(node);
  if (!meets(ray, tree.bv)) return;
  if (tree.isLeaf()) {
    crossTriangle(tree.primitiveId(), ray, crossings);
    return;
  }
  cross(tree.leftChild(), ray, crossings);
  cross(tree.rightChild(), ray, crossings);
}

TriangleSurface::TriangleSurface(const TriangleMesh& mesh) : tree_(std::make_unique<const Tree>(mesh)) {}
TriangleSurface::~TriangleSurface() = default;

TriangleSurface::Nearest TriangleSurface::nearest(const Eigen::Vector3d& point, double bound) const {
  Tree::Search search{point, bound * bound};
  tree_->nearest(0, search);
  return {std::sqrt(search.squared), search.triangle};
}

Eigen::Vector3d TriangleSurface::footOn(int triangle, const Eigen::Vector3d& point) const {
  const auto [a, b, c] = tree_->corners(triangle);
  const Project::ProjectResult found = Project::projectTriangle(a, b, c, point);
  return found.parameterization[0] * a + found.parameterization[1] * b + found.parameterization[2] * c;
}

const Eigen::Vector3d& TriangleSurface::normal(int triangle) const {
  return tree_->normals[static_cast<std::size_t>(triangle)];
}

double TriangleSurface::windingNumber(const Eigen::Vector3d& point) const {
  AngleSum halves;
  const double far = tree_->solidAngle(0, point, halves);
  return (far + 2.0 * halves.sum()) / (4.0 * kPi);
}

double TriangleSurface::windingGradient(double clearance) const {
  return tree_->open_edges / (4.0 * kPi * clearance * clearance);
}

double TriangleSurface::openEdges() const { return tree_->open_edges; }

std::vector<TriangleSurface::Crossing> TriangleSurface::crossings(const Eigen::Vector3d& from,
                                                                  const Eigen::Vector3d& direction,
                                                                  double length) const {
  std::vector<Crossing> found;
  tree_->cross(0, {from, direction, length}, found);
  std::sort(found.begin(), found.end(),
            [](const Crossing& a, const Crossing& b) { return a.along < b.along; });
  return found;
}

}  // namespace shallow_sand
