#include "triangle_surface.h"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/math/bv/AABB.h>
#include <fcl/math/detail/project.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "shallow_sand/core/parameters.h"

namespace shallow_sand {
namespace {

constexpr double kPi = 3.14159265358979323846;
/// A node is seen as a series from this many of its radii on. There the series was found wrong by up to 0.05
/// on a sphere, 0.04 on a bowl, 0.1 on four spheres in one another, 0.006 on loose triangles; three radii
/// halve that and cost more.
constexpr double kFarInRadii = 2.0;
constexpr int kTogether = 8;    ///< points whose winding numbers are computed at once
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
  double open_edges = 0.0;                          ///< length [m]
  double radius = 0.0;                              ///< no part of the surface is farther from `centre`
};

using Corners = std::array<Eigen::Vector3d, 3>;

/// Three plain numbers, of which the compiler makes loops that work on several points at once.
struct Plain {
  double x, y, z;

  explicit Plain(const Eigen::Vector3d& vector) : Plain(vector.x(), vector.y(), vector.z()) {}
  Plain(double x, double y, double z) : x(x), y(y), z(z) {}
  Plain operator-(const Plain& other) const { return {x - other.x, y - other.y, z - other.z}; }
  double dot(const Plain& other) const { return x * other.x + y * other.y + z * other.z; }
  double norm() const { return std::sqrt(dot(*this)); }
  Plain cross(const Plain& other) const {
    return {y * other.z - z * other.y, z * other.x - x * other.z, x * other.y - y * other.x};
  }
};

#ifdef __x86_64__
template <typename Work>
__attribute__((target("avx2"), flatten)) void runAvx2(const Work& work) {
  work();
}
#endif

/// Runs loops on the registers of `instructions`; the same bits either way.
template <typename Work>
void runOn(InstructionSet instructions, const Work& work) {
#ifdef __x86_64__
  if (instructions != InstructionSet::baseline) return runAvx2(work);
#endif
  (void)instructions;
  work();
}

/// What points that lie together see of the surface.
template <int count>
class Views {
 public:
  Views(const Eigen::Vector3d* points, InstructionSet instructions) : instructions_(instructions) {
    Eigen::AlignedBox3d box;
    for (int i = 0; i < count; ++i) {
      x_[i] = points[i].x();
      y_[i] = points[i].y();
      z_[i] = points[i].z();
      real_[i] = 1.0;
      box.extend(points[i]);
    }
    middle_ = box.center();
    radius_ = box.diagonal().norm() / 2.0;
  }

  bool areFarFrom(const Moments& moments) const {
    const double far = kFarInRadii * moments.radius + radius_;
    return (moments.centre - middle_).squaredNorm() > far * far;
  }

  void addTriangle(const Corners& triangle) {
    runOn(instructions_, [&] { multiplyBy(triangle); });
    if (++factors_ % kFactors == 0) shrink();
  }
  void addSeries(const Moments& moments) {
    runOn(instructions_, [&] { addToFar(moments); });
  }

  double windingNumber(int i) const {
    return (far_[i] + 2.0 * std::atan2(imaginary_[i], real_[i]) + 4.0 * kPi * turns_[i]) / (4.0 * kPi);
  }

 private:
  /// Half the solid angle of a triangle, Van Oosterom and Strackee 1983; positive for points behind it. A sum
  /// of such angles is the angle of a product of complex numbers, which is quicker than an arc tangent each.
  void multiplyBy(const Corners& triangle) {
    const Plain first(triangle[0]), second(triangle[1]), third(triangle[2]);
    for (int i = 0; i < count; ++i) {
      const Plain point(x_[i], y_[i], z_[i]);
      const Plain a = first - point;
      const Plain b = second - point;
      const Plain c = third - point;
      const double a_length = a.norm();
      const double b_length = b.norm();
      const double c_length = c.norm();
      double real =
          a_length * b_length * c_length + a.dot(b) * c_length + b.dot(c) * a_length + c.dot(a) * b_length;
      const double imaginary = a.dot(b.cross(c));
      // On an edge or a corner there is no angle.
      real = std::abs(real) + std::abs(imaginary) > 0.0 ? real : 1.0;
      const double product_real = real_[i] * real - imaginary_[i] * imaginary;
      const double product_imaginary = real_[i] * imaginary + imaginary_[i] * real;
      // Two angles of one half plane whose sum lies in the other one went past π.
      const double up = product_imaginary < 0.0 ? 1.0 : 0.0;
      const double down = 1.0 - up;
      turns_[i] += imaginary_[i] >= 0.0 ? (imaginary >= 0.0 ? up : 0.0) : (imaginary < 0.0 ? -down : 0.0);
      real_[i] = product_real;
      imaginary_[i] = product_imaginary;
    }
  }

  void addToFar(const Moments& moments) {
    const Plain centre(moments.centre), area(moments.area_vector);
    const Plain row_x(moments.first.row(0)), row_y(moments.first.row(1)), row_z(moments.first.row(2));
    const double trace = moments.first.trace();
    for (int i = 0; i < count; ++i) {
      const Plain away = centre - Plain(x_[i], y_[i], z_[i]);
      const Plain turned(row_x.dot(away), row_y.dot(away), row_z.dot(away));
      const double inverse = 1.0 / away.dot(away);
      far_[i] += inverse * std::sqrt(inverse) * (area.dot(away) + trace - 3.0 * inverse * away.dot(turned));
    }
  }

  static constexpr int kFactors = 4;  ///< of so many no product leaves the range of a double

  void shrink() {
    for (int i = 0; i < count; ++i) {
      const double size = std::abs(real_[i]) + std::abs(imaginary_[i]);
      real_[i] /= size;
      imaginary_[i] /= size;
    }
  }

  double x_[count], y_[count], z_[count];
  double real_[count], imaginary_[count] = {}, turns_[count] = {};
  double far_[count] = {};
  int factors_ = 0;
  InstructionSet instructions_;
  Eigen::Vector3d middle_;
  double radius_;  ///< no point is farther from the middle [m]
};

bool hasArea(const TriangleMesh& mesh, const std::array<int, 3>& triangle) {
  const Eigen::Vector3d& a = mesh.vertices[static_cast<std::size_t>(triangle[0])];
  const Eigen::Vector3d u = mesh.vertices[static_cast<std::size_t>(triangle[1])] - a;
  const Eigen::Vector3d v = mesh.vertices[static_cast<std::size_t>(triangle[2])] - a;
  // Below this its normal is noise, and so would be a distance to its plane; its edges belong to its
  // neighbours.
  return u.cross(v).norm() > 1e-10 * std::max({u.squaredNorm(), v.squaredNorm(), (u - v).squaredNorm()});
}

/// A side of a triangle that is not cancelled by others at the same place which run the other way.
struct OpenEdge {
  int triangle;
  int corner;  ///< that it starts from
  int count;   ///< how many more run one way than the other
};

std::vector<OpenEdge> openEdgesOf(const Model& model) {
  struct Side {
    std::array<double, 6> place;  ///< the same for both directions
    OpenEdge edge;                ///< count: the direction, 1 or −1
  };
  std::vector<Side> sides;
  sides.reserve(3 * static_cast<std::size_t>(model.num_tris));
  for (int i = 0; i < model.num_tris; ++i) {
    for (int corner = 0; corner < 3; ++corner) {
      const Eigen::Vector3d& from = model.vertices[model.tri_indices[i][corner]];
      const Eigen::Vector3d& to = model.vertices[model.tri_indices[i][(corner + 1) % 3]];
      const std::array<double, 6> there{from.x(), from.y(), from.z(), to.x(), to.y(), to.z()};
      const std::array<double, 6> back{to.x(), to.y(), to.z(), from.x(), from.y(), from.z()};
      sides.push_back({std::min(there, back), {i, corner, there < back ? 1 : -1}});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.place < b.place; });
  std::vector<OpenEdge> open;
  for (auto first = sides.begin(); first != sides.end();) {
    OpenEdge edge = first->edge;
    auto next = first + 1;
    for (; next != sides.end() && next->place == first->place; ++next) edge.count += next->edge.count;
    edge.count = std::abs(edge.count);
    if (edge.count != 0) open.push_back(edge);
    first = next;
  }
  return open;
}

double squaredDistanceToEdge(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                             const Eigen::Vector3d& point) {
  const Eigen::Vector3d along = to - from;
  const double part = std::clamp((point - from).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (from + part * along - point).squaredNorm();
}

}  // namespace

/// The mesh in FCL's bounding volume hierarchy. fcl::distance itself is of no use here: for a point it goes
/// through Sphere and Triangle, which leave the distance unset where they touch (FCL 0.7,
/// sphere_triangle-inl.h). So this walks FCL's tree and projects on triangles with FCL's Project.
struct TriangleSurface::Tree {
  explicit Tree(const TriangleMesh& mesh);
  void gatherMoments(int node);

  bool isLeaf(int node) const { return model.getBV(node).first_child < 0; }
  int triangleOf(int leaf) const { return -model.getBV(leaf).first_child - 1; }
  int leftOf(int node) const { return model.getBV(node).first_child; }
  int rightOf(int node) const { return model.getBV(node).first_child + 1; }
  const Corners& corners(int triangle) const { return triangles[static_cast<std::size_t>(triangle)]; }
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
  template <int count>
  void look(int node, Views<count>& views) const;

  struct Ray {
    Eigen::Vector3d from;
    Eigen::Vector3d direction;
    double length;
    Eigen::Vector3d inverse = direction.cwiseInverse();
  };
  bool meets(const Ray& ray, const fcl::AABB<double>& box) const;
  void cross(int node, const Ray& ray, std::vector<Crossing>& crossings) const;
  void crossTriangle(int triangle, const Ray& ray, std::vector<Crossing>& crossings) const;

  /// At most ∫dl/r² along the open edges below `node`, r from anywhere within `radius` of `middle`. [1/m]
  double openEdgesSeen(int node, const Eigen::Vector3d& middle, double radius) const;
  double openEdgesOfLeafSeen(int triangle, const Eigen::Vector3d& middle, double radius) const;

  Model model;
  std::vector<Corners> triangles;
  std::vector<Moments> moments;          ///< one a node
  std::vector<Eigen::Vector3d> normals;  ///< one a triangle
  std::vector<std::array<int, 3>> open;  ///< one a triangle: how often the edge from each corner is open
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
  for (int i = 0; i < model.num_tris; ++i) {
    const fcl::Triangle& indices = model.tri_indices[i];
    triangles.push_back({model.vertices[indices[0]], model.vertices[indices[1]], model.vertices[indices[2]]});
  }
  open.resize(static_cast<std::size_t>(model.num_tris), {0, 0, 0});
  for (const OpenEdge& edge : openEdgesOf(model)) {
    open[static_cast<std::size_t>(edge.triangle)][static_cast<std::size_t>(edge.corner)] = edge.count;
  }
  moments.resize(static_cast<std::size_t>(model.getNumBVs()));
  gatherMoments(0);
  for (int i = 0; i < model.num_tris; ++i) {
    const auto& [a, b, c] = corners(i);
    normals.push_back((b - a).cross(c - a).normalized());
  }
}

void TriangleSurface::Tree::gatherMoments(int node) {
  const auto& tree = model.getBV(node);
  Moments& sum = moments[static_cast<std::size_t>(node)];
  if (isLeaf(node)) {
    const auto& [a, b, c] = corners(triangleOf(node));
    sum.area_vector = (b - a).cross(c - a) / 2.0;
    sum.area = sum.area_vector.norm();
    sum.centre = (a + b + c) / 3.0;
    const std::array<int, 3>& counts = open[static_cast<std::size_t>(triangleOf(node))];
    sum.open_edges = counts[0] * (b - a).norm() + counts[1] * (c - b).norm() + counts[2] * (a - c).norm();
    sum.radius = std::max({(a - sum.centre).norm(), (b - sum.centre).norm(), (c - sum.centre).norm()});
  } else {
    gatherMoments(leftOf(node));
    gatherMoments(rightOf(node));
    const Moments& left = at(leftOf(node));
    const Moments& right = at(rightOf(node));
    sum.area = left.area + right.area;
    sum.centre = (left.area * left.centre + right.area * right.centre) / sum.area;
    sum.open_edges = left.open_edges + right.open_edges;
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
  const auto& [a, b, c] = corners(triangle);
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
  if (isLeaf(node)) {
    compare(triangleOf(node), search);
    return;
  }
  int near = leftOf(node);
  int far = rightOf(node);
  double to_near = squaredDistanceToBox(near, search.point);
  double to_far = squaredDistanceToBox(far, search.point);
  if (to_far < to_near) {
    std::swap(near, far);
    std::swap(to_near, to_far);
  }
  if (to_near <= search.squared * (1.0 + kTie)) nearest(near, search);
  if (to_far <= search.squared * (1.0 + kTie)) nearest(far, search);
}

template <int count>
void TriangleSurface::Tree::look(int node, Views<count>& views) const {
  if (views.areFarFrom(at(node))) {
    views.addSeries(at(node));
  } else if (isLeaf(node)) {
    views.addTriangle(corners(triangleOf(node)));
  } else {
    look(leftOf(node), views);
    look(rightOf(node), views);
  }
}

bool TriangleSurface::Tree::meets(const Ray& ray, const fcl::AABB<double>& box) const {
  double enter = 0.0;
  double leave = ray.length;
  for (int axis = 0; axis < 3; ++axis) {
    if (ray.direction[axis] == 0.0) {
      if (ray.from[axis] < box.min_[axis] || ray.from[axis] > box.max_[axis]) return false;
      continue;
    }
    const double low = (box.min_[axis] - ray.from[axis]) * ray.inverse[axis];
    const double high = (box.max_[axis] - ray.from[axis]) * ray.inverse[axis];
    enter = std::max(enter, std::min(low, high));
    leave = std::min(leave, std::max(low, high));
  }
  return enter <= leave + 1e-9 * ray.length;
}

void TriangleSurface::Tree::crossTriangle(int triangle, const Ray& ray,
                                          std::vector<Crossing>& crossings) const {
  const auto& [a, b, c] = corners(triangle);
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
  if (isLeaf(node)) {
    crossTriangle(triangleOf(node), ray, crossings);
    return;
  }
  cross(leftOf(node), ray, crossings);
  cross(rightOf(node), ray, crossings);
}

double TriangleSurface::Tree::openEdgesOfLeafSeen(int triangle, const Eigen::Vector3d& middle,
                                                  double radius) const {
  const Corners points = corners(triangle);
  double sum = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const int count = open[static_cast<std::size_t>(triangle)][i];
    if (count == 0) continue;
    const Eigen::Vector3d& from = points[i];
    const Eigen::Vector3d& to = points[(i + 1) % 3];
    const double clearance = std::sqrt(squaredDistanceToEdge(from, to, middle)) - radius;
    if (clearance <= 0.0) return std::numeric_limits<double>::infinity();
    // The second is that of an endless straight line.
    sum += count * std::min((to - from).norm() / clearance, kPi) / clearance;
  }
  return sum;
}

double TriangleSurface::Tree::openEdgesSeen(int node, const Eigen::Vector3d& middle, double radius) const {
  const double length = at(node).open_edges;
  if (length == 0.0) return 0.0;
  if (isLeaf(node)) return openEdgesOfLeafSeen(triangleOf(node), middle, radius);
  const double clearance = std::sqrt(squaredDistanceToBox(node, middle)) - radius;
  if (clearance > at(node).radius) return length / (clearance * clearance);
  return openEdgesSeen(leftOf(node), middle, radius) + openEdgesSeen(rightOf(node), middle, radius);
}

TriangleSurface::TriangleSurface(const TriangleMesh& mesh, InstructionSet instructions)
    : tree_(std::make_unique<const Tree>(mesh)), instructions_(instructions) {}
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
  Views<1> view(&point, instructions_);
  tree_->look(0, view);
  return view.windingNumber(0);
}

std::vector<double> TriangleSurface::windingNumbers(std::vector<Eigen::Vector3d> points) const {
  const std::size_t asked = points.size();
  points.resize((asked + kTogether - 1) / kTogether * kTogether, points.back());
  std::vector<double> numbers;
  for (std::size_t first = 0; first < points.size(); first += kTogether) {
    Views<kTogether> views(&points[first], instructions_);
    tree_->look(0, views);
    for (int i = 0; i < kTogether; ++i) numbers.push_back(views.windingNumber(i));
  }
  numbers.resize(asked);
  return numbers;
}

double TriangleSurface::windingGradient(const Eigen::Vector3d& middle, double radius) const {
  return tree_->openEdgesSeen(0, middle, radius) / (4.0 * kPi);
}

double TriangleSurface::openEdges() const { return tree_->at(0).open_edges; }

std::vector<TriangleSurface::Crossing> TriangleSurface::crossings(const Eigen::Vector3d& from,
                                                                  const Eigen::Vector3d& direction,
                                                                  double length) const {
  std::vector<Crossing> found;
  tree_->cross(0, Tree::Ray{from, direction, length}, found);
  std::sort(found.begin(), found.end(),
            [](const Crossing& a, const Crossing& b) { return a.along < b.along; });
  return found;
}

}  // namespace shallow_sand
