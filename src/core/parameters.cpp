#include "shallow_sand/core/parameters.h"

#include <cmath>
#include <sstream>

#include "shallow_sand/core/one_line.h"

namespace shallow_sand {

namespace {

constexpr double kMaximumCells = 268435456.0;  // 2^28: 7.5 GB of fields, and indices that fit an int
constexpr double kMaximumGrains = 67108864.0;  // 2^26: 2.7 GB, and numbers that fit Claim

std::string text(double value) {
  std::ostringstream stream;
  stream << value;
  return stream.str();
}

void requirePositive(const std::string& key, double value, const std::string& unit) {
  if (!(value > 0.0) || !std::isfinite(value)) {
    throw InvalidParameter(key, text(value), "a positive, finite number of " + unit);
  }
}

void requireFinite(const std::string& key, double value, const std::string& unit) {
  if (!std::isfinite(value)) throw InvalidParameter(key, text(value), "a finite number of " + unit);
}

void requireStep(const std::string& key, double value) {
  if (value >= 1e-6 && std::isfinite(value)) return;
  throw InvalidParameter(key, text(value), "a positive, finite number of seconds, at least 1e-6");
}

int cellsAlong(const std::string& key, double size, double spacing) {
  const double count = std::round(size / spacing);
  if (count < 1.0) {
    throw InvalidParameter(key, text(size), "at least one cell of grid.spacing " + text(spacing) + " m");
  }
  if (count > kMaximumCells) {
    throw InvalidParameter(key, text(size), "at most 2^28 cells of grid.spacing " + text(spacing) + " m");
  }
  if (std::abs(count * spacing - size) > 1e-6 * size) {
    throw InvalidParameter(key, text(size),
                           "a whole number of cells of grid.spacing " + text(spacing) + " m");
  }
  return static_cast<int>(count);
}

}  // namespace

InvalidParameter::InvalidParameter(const std::string& key, const std::string& found,
                                   const std::string& expected)
    : std::runtime_error(oneLine(key) + ": " + oneLine(found) + "; expected " + oneLine(expected)),
      expected_(expected) {}

void GridParameters::validate() const {
  requirePositive("grid.spacing", spacing, "metres");
  requirePositive("grid.size[0]", size.x(), "metres");
  requirePositive("grid.size[1]", size.y(), "metres");
  requireFinite("grid.origin[0]", origin.x(), "metres");
  requireFinite("grid.origin[1]", origin.y(), "metres");
  const double columns = cellsAlong("grid.size[0]", size.x(), spacing);
  const double rows = cellsAlong("grid.size[1]", size.y(), spacing);
  if (columns * rows > kMaximumCells) {
    throw InvalidParameter("grid", text(columns) + " x " + text(rows) + " cells", "at most 2^28 cells");
  }
  if (frame.empty()) throw InvalidParameter("grid.frame", "an empty name", "the name of a tf frame");
}

Grid GridParameters::grid() const {
  validate();
  Grid grid;
  grid.columns = cellsAlong("grid.size[0]", size.x(), spacing);
  grid.rows = cellsAlong("grid.size[1]", size.y(), spacing);
  grid.spacing = static_cast<float>(spacing);
  grid.origin_x = origin.x();
  grid.origin_y = origin.y();
  return grid;
}

void Material::validate() const {
  constexpr double kDegree = M_PI / 180.0;
  if (!(friction_angle >= 0.0 && friction_angle < 90.0 * kDegree)) {
    throw InvalidParameter("material.friction_angle", text(friction_angle / kDegree),
                           "an angle from 0 to less than 90 degrees");
  }
  if (!(layer_fraction > 0.0 && layer_fraction <= 1.0)) {
    throw InvalidParameter("material.dilute_layer.fraction", text(layer_fraction),
                           "a number above 0, at most 1");
  }
  if (!(layer_depth > 0.0)) {
    throw InvalidParameter("material.dilute_layer.depth", text(layer_depth),
                           "a positive number of metres, or .inf");
  }
}

void SolverParameters::validate() const {
  if (!(courant > 0.0 && courant < 1.0)) {
    throw InvalidParameter("solver.courant", text(courant), "a number between 0 and 1");
  }
  requireStep("solver.max_step", max_step);
  if (fixed_step) requireStep("solver.fixed_step", *fixed_step);
}

void GrainParameters::validate(const Grid& grid) const {
  const auto require = [](const std::string& key, int value, int most) {
    if (value < 1 || value > most)
      throw InvalidParameter(key, std::to_string(value), "a whole number from 1 to " + std::to_string(most));
  };
  require("grains.per_cell", per_cell, 64);
  require("grains.layers", layers, 1024);
  const double count = static_cast<double>(grid.cells()) * per_cell * per_cell * layers;
  if (count > kMaximumGrains) {
    throw InvalidParameter("grains", text(count) + " grains",
                           "at most 2^26: fewer per_cell or layers, or a smaller grid");
  }
}

void Region::validate() const {
  requireFinite("center[0]", center.x(), "metres");
  requireFinite("center[1]", center.y(), "metres");
  if (shape == Shape::disc) {
    requirePositive("radius", radius, "metres");
  } else {
    requirePositive("size[0]", size.x(), "metres");
    requirePositive("size[1]", size.y(), "metres");
  }
}

void Edit::validate() const {
  region.validate();
  requireFinite("value", value, "metres");
  if (value < 0.0 && operation != EditOperation::level)
    throw InvalidParameter("value", text(value), "a number of metres that is not negative");
}

void Pour::validate() const {
  requireFinite("position[0]", position.x(), "metres");
  requireFinite("position[1]", position.y(), "metres");
  requirePositive("radius", radius, "metres");
  requireFinite("rate", rate, "cubic metres a second");
  requireFinite("start", start, "seconds");
  if (!(stop > start))
    throw InvalidParameter("stop", text(stop), "a time after start (" + text(start) + " s)");
}

void validateGravity(const Eigen::Vector3d& gravity) {
  // Of a centrifuge for soils, and some more; sand that fell faster would take steps without end.
  constexpr double kStrongest = 1e4;
  if (!(gravity.array().abs() <= kStrongest).all() || !(gravity.z() < 0.0)) {
    throw InvalidParameter(
        "gravity", "[" + text(gravity.x()) + ", " + text(gravity.y()) + ", " + text(gravity.z()) + "]",
        "three numbers of m/s^2, at most 1e4 in size, the third negative (z points up)");
  }
}

}  // namespace shallow_sand
