#include "solver_3d/material_points.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdint>

namespace shallow_sand {
namespace {

// A point reaches three nodes along each axis: points of a block never write where those of the block after
// the next do.
constexpr int kBlock = 4;    // columns of cells along x and y
constexpr int kPerCell = 2;  // points along each axis
constexpr int kPadding = 1;  // nodes beyond the box on each side

/// The nodes that a point reaches, and how much of it each gets: quadratic splines.
struct Stencil {
  Eigen::Vector3i first;   ///< node
  Eigen::Vector3d offset;  ///< from the point to that node [cells]
  double weight[3][3];     ///< of the nodes along each axis

  Stencil(const Eigen::Vector3d& position, double spacing) {
    for (int axis = 0; axis < 3; ++axis) {
      const double place = position[axis] / spacing + kPadding;
      first[axis] = static_cast<int>(std::floor(place - 0.5));
      offset[axis] = first[axis] - place;
      const double middle = offset[axis] + 1.0;  // from -0.5 to 0.5
      weight[axis][0] = 0.5 * (0.5 + middle) * (0.5 + middle);
      weight[axis][1] = 0.75 - middle * middle;
      weight[axis][2] = 0.5 * (0.5 - middle) * (0.5 - middle);
    }
  }
};

Eigen::Array4d with(const Eigen::Vector3d& vector, double last) {
  return {vector.x(), vector.y(), vector.z(), last};
}

}  // namespace

MaterialPoints::MaterialPoints(const MaterialPointParameters& parameters) : parameters_(parameters) {
  const double nu = parameters.poisson_ratio;
  shear_modulus_ = 0.5 * parameters.youngs_modulus / (1.0 + nu);
  lame_modulus_ = parameters.youngs_modulus * nu / ((1.0 + nu) * (1.0 - 2.0 * nu));
  // Klár et al. match the cone to Mohr and Coulomb's pyramid at its edges, and sand of 30 degrees stands at
  // up to
  // 44. Flanks slide in plane strain without getting wider; there the cone must meet the pyramid.
  cone_ = std::sqrt(2.0) / 3.0 * std::sin(parameters.friction_angle);
  volume_ = std::pow(parameters.spacing / kPerCell, 3);
  mass_ = parameters.density * volume_;
  nodes_ = parameters.cells.array() + 1 + 2 * kPadding;
  blocks_ = nodes_.array() / kBlock + 1;
  grid_.resize(static_cast<std::size_t>(nodes_.prod()));
}

std::size_t MaterialPoints::node(int i, int j, int k) const {
  return static_cast<std::size_t>((i * nodes_.y() + j) * nodes_.z() + k);
}

void MaterialPoints::fill(const std::vector<double>& depth) {
  const double apart = parameters_.spacing / kPerCell;
  const int columns = parameters_.cells.x();
  Point point{};
  point.elastic_strain.setIdentity();
  for (int i = 0; i < kPerCell * columns; ++i) {
    for (int j = 0; j < kPerCell * parameters_.cells.y(); ++j) {
      const double top = depth[static_cast<std::size_t>(j / kPerCell * columns + i / kPerCell)];
      for (int k = 0; (k + 0.5) * apart < top; ++k) {
        point.position = apart * (Eigen::Vector3d(i, j, k).array() + 0.5);
        points_.push_back(point);
      }
    }
  }
}

void MaterialPoints::launch(const Eigen::Vector3d& way, const Eigen::Vector3d& velocity) {
  for (Point& point : points_) {
    point.position += way;
    point.velocity = velocity;
  }
}

void MaterialPoints::advance(double duration) {
  const double end = time_ + duration;
  while (time_ < end) step(std::min(longestStep(), end - time_));
}

double MaterialPoints::longestStep() const {
  const double wave_speed = std::sqrt((lame_modulus_ + 2.0 * shear_modulus_) / parameters_.density);
  double fastest = 0.0;
  for (const Point& point : points_) fastest = std::max(fastest, point.velocity.squaredNorm());
  return parameters_.courant * parameters_.spacing / (wave_speed + std::sqrt(fastest));
}

void MaterialPoints::step(double duration) {
  sortIntoBlocks();
  transferToGrid(duration);
  updateGrid(duration);
  transferToPoints(duration);
  time_ += duration;
  ++steps_;
}

void MaterialPoints::sortIntoBlocks() {
  std::vector<std::size_t> block_of(points_.size());
  block_begin_.assign(static_cast<std::size_t>(blocks_.x() * blocks_.y()) + 1, 0);
  for (std::size_t p = 0; p < points_.size(); ++p) {
    const Eigen::Vector3i first = Stencil(points_[p].position, parameters_.spacing).first / kBlock;
    block_of[p] = static_cast<std::size_t>(first.x() * blocks_.y() + first.y());
    ++block_begin_[block_of[p] + 1];
  }
  for (std::size_t b = 1; b < block_begin_.size(); ++b) block_begin_[b] += block_begin_[b - 1];
  std::vector<std::size_t> next = block_begin_;
  order_.resize(points_.size());
  for (std::size_t p = 0; p < points_.size(); ++p) order_[next[block_of[p]]++] = p;
}

void MaterialPoints::transferToGrid(double duration) {
#pragma omp parallel for num_threads(parameters_.threads)
  for (std::int64_t n = 0; n < static_cast<std::int64_t>(grid_.size()); ++n)
    grid_[static_cast<std::size_t>(n)].setZero();
  for (int colour = 0; colour < 4; ++colour) {
#pragma omp parallel for collapse(2) schedule(dynamic) num_threads(parameters_.threads)
    for (int bx = colour % 2; bx < blocks_.x(); bx += 2) {
      for (int by = colour / 2; by < blocks_.y(); by += 2) {
        const auto block = static_cast<std::size_t>(bx * blocks_.y() + by);
        for (std::size_t n = block_begin_[block]; n < block_begin_[block + 1]; ++n)
          scatter(points_[order_[n]], duration);
      }
    }
  }
}

void MaterialPoints::scatter(const Point& point, double duration) {
  const double dx = parameters_.spacing;
  const Stencil stencil(point.position, dx);
  // The inverse of the splines' second moment is 4/ΔL² (Hu et al., Eq. 16).
  const Eigen::Matrix3d affine =
      dx * (mass_ * point.velocity_gradient - (duration * volume_ * 4.0 / (dx * dx)) * point.stress);
  const Node at_first = with(mass_ * point.velocity + affine * stencil.offset, mass_);
  const Node along[3] = {with(affine.col(0), 0.0), with(affine.col(1), 0.0), with(affine.col(2), 0.0)};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const Node row = at_first + i * along[0] + j * along[1];
      const double weight = stencil.weight[0][i] * stencil.weight[1][j];
      Node* nodes = &grid_[node(stencil.first.x() + i, stencil.first.y() + j, stencil.first.z())];
      for (int k = 0; k < 3; ++k) nodes[k] += (weight * stencil.weight[2][k]) * (row + k * along[2]);
    }
  }
}

void MaterialPoints::updateGrid(double duration) {
  std::vector<Eigen::Vector3d> impulses(static_cast<std::size_t>(nodes_.x()));
#pragma omp parallel for num_threads(parameters_.threads)
  for (int i = 0; i < nodes_.x(); ++i) impulses[static_cast<std::size_t>(i)] = updatePlane(i, duration);
  for (const Eigen::Vector3d& impulse : impulses) impulse_ += impulse;
}

/// Turns momentum into velocity. @returns what the box gave to the nodes
Eigen::Vector3d MaterialPoints::updatePlane(int i, double duration) {
  Eigen::Vector3d impulse = Eigen::Vector3d::Zero();
  for (int j = 0; j < nodes_.y(); ++j) {
    for (int k = 0; k < nodes_.z(); ++k) {
      Node& here = grid_[node(i, j, k)];
      const double mass = here[3];
      if (mass <= 0.0) continue;
      const Eigen::Vector3d free = here.head<3>().matrix() / mass + duration * parameters_.gravity;
      const Eigen::Vector3d bounded = boundedVelocity(i, j, k, free);
      impulse += mass * (bounded - free);
      here.head<3>() = bounded.array();
    }
  }
  return impulse;
}

Eigen::Vector3d MaterialPoints::boundedVelocity(int i, int j, int k, Eigen::Vector3d velocity) const {
  if (k <= kPadding && velocity.z() < 0.0) {
    const double speed = velocity.head<2>().norm();
    const double taken = -std::tan(parameters_.friction_angle) * velocity.z();
    velocity.head<2>() *= speed > taken ? 1.0 - taken / speed : 0.0;
    velocity.z() = 0.0;
  }
  const Eigen::Vector3i place(i, j, k);
  for (int axis = 0; axis < 3; ++axis) {
    if (place[axis] <= kPadding) velocity[axis] = std::max(velocity[axis], 0.0);
    if (place[axis] >= parameters_.cells[axis] + kPadding) velocity[axis] = std::min(velocity[axis], 0.0);
  }
  return velocity;
}

void MaterialPoints::transferToPoints(double duration) {
#pragma omp parallel for num_threads(parameters_.threads)
  for (std::int64_t n = 0; n < static_cast<std::int64_t>(order_.size()); ++n) {
    Point& point = points_[order_[static_cast<std::size_t>(n)]];
    gather(point, duration);
    deform(point, duration);
  }
}

void MaterialPoints::gather(Point& point, double duration) const {
  const double dx = parameters_.spacing;
  const Stencil stencil(point.position, dx);
  Node velocity = Node::Zero();
  Node moment[3] = {Node::Zero(), Node::Zero(), Node::Zero()};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const double weight = stencil.weight[0][i] * stencil.weight[1][j];
      const Node* nodes = &grid_[node(stencil.first.x() + i, stencil.first.y() + j, stencil.first.z())];
      Node row = Node::Zero();
      for (int k = 0; k < 3; ++k) {
        const Node part = (weight * stencil.weight[2][k]) * nodes[k];
        row += part;
        moment[2] += (stencil.offset.z() + k) * part;
      }
      velocity += row;
      moment[0] += (stencil.offset.x() + i) * row;
      moment[1] += (stencil.offset.y() + j) * row;
    }
  }
  point.velocity = velocity.head<3>().matrix();
  for (int axis = 0; axis < 3; ++axis)
    point.velocity_gradient.col(axis) = (4.0 / dx) * moment[axis].head<3>().matrix();
  point.position = (point.position + duration * point.velocity)
                       .cwiseMax(0.0)
                       .cwiseMin(dx * parameters_.cells.cast<double>());
}

/// Hencky's elasticity and the return mapping of Klár et al., section 7. Both are isotropic, so that b = F Fᵀ
/// does for F and its singular values. The volume that torn sand gains is kept and taken off again when it is
/// pressed (Tampubolon et al. 2017): it would else settle on too large a volume.
void MaterialPoints::deform(Point& point, double duration) const {
  const Eigen::Matrix3d change = Eigen::Matrix3d::Identity() + duration * point.velocity_gradient;
  const Eigen::Matrix3d trial = change * point.elastic_strain * change.transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(0.5 * (trial + trial.transpose()));
  const Eigen::Matrix3d& axes = solver.eigenvectors();
  const Eigen::Array3d elastic = 0.5 * solver.eigenvalues().array().log();
  Eigen::Array3d strain = elastic + point.volume_gain / 3.0;
  const double volumetric = strain.sum();
  if (volumetric >= 0.0) {
    strain.setZero();
  } else {
    const Eigen::Array3d deviator = strain - volumetric / 3.0;
    const double size = deviator.matrix().norm();
    const double stiffness = (3.0 * lame_modulus_ + 2.0 * shear_modulus_) / (2.0 * shear_modulus_);
    const double beyond = size + stiffness * volumetric * cone_;
    if (beyond > 0.0) strain -= (beyond / size) * deviator;
  }
  point.volume_gain += elastic.sum() - strain.sum();
  point.elastic_strain = axes * (2.0 * strain).exp().matrix().asDiagonal() * axes.transpose();
  const Eigen::Array3d stress = 2.0 * shear_modulus_ * strain + lame_modulus_ * strain.sum();
  point.stress = axes * stress.matrix().asDiagonal() * axes.transpose();
}

Eigen::Vector3d MaterialPoints::momentum() const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Point& point : points_) sum += point.velocity;
  return mass_ * sum;
}

Eigen::Vector3d MaterialPoints::centre() const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Point& point : points_) sum += point.position;
  return sum / static_cast<double>(size());
}

double MaterialPoints::kineticEnergy() const {
  const double second_moment = 0.25 * parameters_.spacing * parameters_.spacing;
  double sum = 0.0;
  for (const Point& point : points_)
    sum += point.velocity.squaredNorm() + second_moment * point.velocity_gradient.squaredNorm();
  return 0.5 * mass_ * sum;
}

double MaterialPoints::elasticEnergy() const {
  const double bulk = 3.0 * lame_modulus_ + 2.0 * shear_modulus_;
  double sum = 0.0;
  for (const Point& point : points_) {
    const double trace = point.stress.trace();
    sum += (point.stress.squaredNorm() - lame_modulus_ / bulk * trace * trace) / (4.0 * shear_modulus_);
  }
  return volume_ * sum;
}

std::vector<double> MaterialPoints::depth() const {
  const int columns = parameters_.cells.x();
  std::vector<double> result(static_cast<std::size_t>(columns * parameters_.cells.y()), 0.0);
  for (const Point& point : points_) {
    const Eigen::Array2d place = point.position.head<2>().array() / parameters_.spacing;
    const Eigen::Array2i cell = place.cast<int>().min(parameters_.cells.head<2>().array() - 1);
    result[static_cast<std::size_t>(cell.y() * columns + cell.x())] += volume_;
  }
  const double area = parameters_.spacing * parameters_.spacing;
  for (double& column : result) column /= area;
  return result;
}

}  // namespace shallow_sand
