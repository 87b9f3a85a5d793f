#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace shallow_sand {

/// Sand that MaterialPoints simulates.
struct MaterialPointParameters {
  Eigen::Vector3i cells{64, 64, 64};         ///< along x, y and z; each at least 1
  double spacing = 0.02;                     ///< of the grid [m], positive
  Eigen::Vector3d gravity{0.0, 0.0, -9.81};  ///< [m/s²]
  double friction_angle = 0.0;               ///< within the sand and on the floor [rad]
  double density = 1600.0;                   ///< of sand at rest [kg/m³]
  double youngs_modulus = 3.5e5;  ///< [Pa]; Klár et al. take this for sand; softer takes longer steps
  double poisson_ratio = 0.3;
  double courant = 0.4;  ///< part of a cell that an elastic wave goes in a step
  int threads = 1;       ///< changes no bit
};

/// A granular solver in three dimensions, for comparison: material points on a regular grid (MLS-MPM of Hu et
/// al. 2018, "A Moving Least Squares Material Point Method with Displacement Discontinuity and Two-Way Rigid
/// Body Coupling", with quadratic splines and the APIC transfer), elastic, and plastic after Drucker and
/// Prager as in Klár et al. 2016, "Drucker-Prager Elastoplasticity for Sand Animation". Explicit, in double
/// precision. The box from the origin to spacing · cells is closed: a floor that rubs, walls and a ceiling
/// that do not.
class MaterialPoints {
 public:
  explicit MaterialPoints(const MaterialPointParameters& parameters);

  /// Puts sand on the floor, at rest and unstressed, eight points to a cell: of each column of cells,
  /// row-major as in Fields, as deep as told [m], to a quarter of a cell.
  void fill(const std::vector<double>& depth);
  /// Moves all sand by `way` [m], to where it must be within the box, and gives it a velocity [m/s].
  void launch(const Eigen::Vector3d& way, const Eigen::Vector3d& velocity);
  /// Runs on by `duration` [s] exactly.
  void advance(double duration);

  double time() const { return time_; }         ///< [s]
  std::size_t steps() const { return steps_; }  ///< since the start
  std::size_t size() const { return points_.size(); }
  double mass() const { return mass_ * static_cast<double>(size()); }  ///< [kg]
  Eigen::Vector3d momentum() const;                                    ///< [kg m/s]
  Eigen::Vector3d centre() const;                                      ///< of mass [m]
  /// What floor, walls and ceiling have given to the sand since the start. [kg m/s]
  const Eigen::Vector3d& impulse() const { return impulse_; }
  double kineticEnergy() const;  ///< [J]
  double elasticEnergy() const;  ///< [J]
  double potentialEnergy() const {
    return -mass() * parameters_.gravity.dot(centre());
  }  ///< of the centre of mass above the floor [J]
  /// Volume of the sand above each column of cells, had it the density of sand at rest, by the column's area;
  /// row-major. [m]
  std::vector<double> depth() const;

 private:
  struct Point {
    Eigen::Vector3d position;
    Eigen::Vector3d velocity;
    Eigen::Matrix3d velocity_gradient;
    Eigen::Matrix3d elastic_strain;  ///< left Cauchy-Green tensor b of the elastic deformation
    Eigen::Matrix3d stress;          ///< after Kirchhoff [Pa]
    double volume_gain;              ///< logarithm of what was gained while it was torn apart
  };
  /// Momentum, then velocity, and mass of a node.
  using Node = Eigen::Array4d;

  double longestStep() const;
  void step(double duration);
  void sortIntoBlocks();
  void transferToGrid(double duration);
  void updateGrid(double duration);
  Eigen::Vector3d updatePlane(int i, double duration);
  Eigen::Vector3d boundedVelocity(int i, int j, int k, Eigen::Vector3d velocity) const;
  void transferToPoints(double duration);
  void scatter(const Point& point, double duration);
  void gather(Point& point, double duration) const;
  void deform(Point& point, double duration) const;
  std::size_t node(int i, int j, int k) const;

  MaterialPointParameters parameters_;
  Eigen::Vector3i nodes_;   ///< along x, y and z
  Eigen::Vector3i blocks_;  ///< of columns of cells; along x and y
  double shear_modulus_;    ///< µ of Lamé [Pa]
  double lame_modulus_;     ///< λ of Lamé [Pa]
  double cone_;             ///< α of Drucker and Prager
  double volume_;           ///< of a point [m³]
  double mass_;             ///< of a point [kg]
  std::vector<Point> points_;
  std::vector<Node> grid_;
  std::vector<std::size_t> order_;        ///< points by blocks
  std::vector<std::size_t> block_begin_;  ///< in order_
  Eigen::Vector3d impulse_ = Eigen::Vector3d::Zero();
  double time_ = 0.0;
  std::size_t steps_ = 0;
};

}  // namespace shallow_sand
