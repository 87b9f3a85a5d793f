#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>

#include "shallow_sand/core/grid.h"

namespace shallow_sand {

/// A parameter outside of its bounds. what() is one line, "KEY: FOUND; expected EXPECTED".
class InvalidParameter : public std::runtime_error {
 public:
  InvalidParameter(const std::string& key, const std::string& found, const std::string& expected);
  const std::string& expected() const { return expected_; }

 private:
  std::string expected_;
};

/// Where the sand is. Scene key `grid`.
struct GridParameters {
  Eigen::Vector2d size{4.0, 2.0};    ///< extent along x and y [m]; a whole number of cells
  double spacing = 0.02;             ///< ΔL [m], positive
  Eigen::Vector2d origin{0.0, 0.0};  ///< corner with the smallest x and y, in `frame` [m]
  std::string frame = "sand";        ///< tf frame of the sand; z points up

  void validate() const;  ///< @throws InvalidParameter
  Grid grid() const;      ///< validates, then counts the cells @throws InvalidParameter
};

/// Dry sand. Scene key `material`.
struct Material {
  double friction_angle = 0.5585053606381855;  ///< [rad], 32°; 0 ≤ angle < 90° (paper: θ, μ = tan θ)
  double layer_fraction = 1.0;  ///< dilute layer h̄: layer(h) = min(fraction·h, depth); 0 < fraction ≤ 1
  double layer_depth = 0.1;     ///< [m], positive, may be infinite (then h̄ = fraction·h)

  void validate() const;  ///< @throws InvalidParameter
};

enum class Edge {
  wall,  ///< nothing crosses
  open   ///< sand that flows out is gone, and counted; nothing flows in
};

/// The four sides of the grid. Scene key `edges`.
struct Edges {
  Edge x_min = Edge::wall;
  Edge x_max = Edge::wall;
  Edge y_min = Edge::wall;
  Edge y_max = Edge::wall;
};

/// How values at the faces of cells follow from those at their centres.
enum class Reconstruction {
  constant,  ///< as at the centre; first order
  minmod     ///< limited slopes of surface and velocity; sharper, and slower
};

/// C of Eq. 14 that suits minmod: with longer steps of first order its smooth slopes turn into terraces.
constexpr double kCourantOfMinmod = 0.25;

/// How space and time are cut. Scene key `solver`.
struct SolverParameters {
  Reconstruction reconstruction = Reconstruction::constant;
  double courant = 0.45;   ///< C of Eq. 14 and 34; 0 < C < 1
  double max_step = 0.01;  ///< no step is longer; at least 1e-6 [s]
  std::optional<double>
      fixed_step;  ///< this step instead [s]; a run in which it breaks the bound of `courant` ends

  void validate() const;  ///< @throws InvalidParameter
};

/// How fast grains go (Eq. 31).
enum class GrainSpeed {
  mean,   ///< as the paper prints it: with the mean velocity of the whole depth
  dilute  ///< those within the dilute layer by h/h̄ faster, those below it not at all
};

/// What grains get their colours from.
enum class GrainColor {
  origin,  ///< where they were at the start
  layer    ///< their layer
};

/// Grains that show how the sand moves (section 6). Scene key `grains`.
struct GrainParameters {
  int per_cell = 4;  ///< along x and along y, in each cell of the grid: ΔL/Δl; from 1 to 64
  int layers = 1;    ///< one below the other, Δl high; from 1 to 1024
  GrainSpeed speed = GrainSpeed::mean;
  GrainColor color = GrainColor::origin;

  /// At most 2^26 grains in all. @throws InvalidParameter
  void validate(const Grid& grid) const;
};

/// A part of the map, in the grid's frame.
struct Region {
  enum class Shape { disc, rectangle };
  Shape shape = Shape::disc;
  Eigen::Vector2d center{0.0, 0.0};  ///< [m]
  double radius = 0.1;               ///< of a disc [m], positive
  Eigen::Vector2d size{0.2, 0.2};    ///< of a rectangle, along x and y [m], positive

  void validate() const;  ///< @throws InvalidParameter
};

/// What an edit does to the sand of each cell in its region.
enum class EditOperation {
  add,     ///< adds `value` metres
  remove,  ///< takes `value` metres away, or all there is
  set,     ///< makes the sand `value` metres deep
  level    ///< fills or cuts to a surface `value` metres high; the bed stays
};

/// A change of the sand at one instant.
struct Edit {
  Region region;
  EditOperation operation = EditOperation::add;
  double value = 0.0;  ///< [m]; not negative unless the operation is `level`

  void validate() const;  ///< @throws InvalidParameter
};

/// Sand that falls on a disc, or is taken from it, at a steady rate. Scene key `pours`.
struct Pour {
  Eigen::Vector2d position{0.0, 0.0};                     ///< centre of the disc, in the grid's frame [m]
  double radius = 0.1;                                    ///< [m], positive
  double rate = 0.0;                                      ///< [m³/s]; negative takes away what is there
  double start = 0.0;                                     ///< [s]
  double stop = std::numeric_limits<double>::infinity();  ///< [s], after start

  void validate() const;  ///< @throws InvalidParameter
};

/// Checks gravity in the grid's frame [m/s²]: at most 1e4 in size, and pointing below the horizon. @throws
/// InvalidParameter
void validateGravity(const Eigen::Vector3d& gravity);

}  // namespace shallow_sand
