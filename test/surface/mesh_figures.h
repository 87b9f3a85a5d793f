#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <vector>

#include "shallow_sand/surface/surface_mesh.h"

namespace shallow_sand {

using Elevation = std::function<double(double x, double y)>;

/// A bed, and sand up to a surface where that is higher.
struct Shapes {
  Elevation bed;
  Elevation surface;

  double depth(double x, double y) const { return surface(x, y) - bed(x, y); }

  Fields fields(const Grid& grid) const {
    Fields result;
    for (int j = 0; j < grid.rows; ++j) {
      for (int i = 0; i < grid.columns; ++i) {
        result.bed.push_back(static_cast<float>(bed(grid.x(i), grid.y(j))));
        result.depth.push_back(static_cast<float>(std::max(0.0, depth(grid.x(i), grid.y(j)))));
      }
    }
    return result;
  }
};

/// A square metre around the origin by `side` × `side` cells.
inline Grid squareMetre(int side) { return {side, side, 1.0f / static_cast<float>(side), -0.5, -0.5}; }

/// Upward normal by central differences of a smooth surface.
inline Eigen::Vector3d exactNormal(const Elevation& elevation, const Eigen::Vector3d& place) {
  constexpr double kReach = 1e-5;
  const double x = place.x(), y = place.y();
  return Eigen::Vector3d(elevation(x - kReach, y) - elevation(x + kReach, y),
                         elevation(x, y - kReach) - elevation(x, y + kReach), 2.0 * kReach)
      .normalized();
}

inline Eigen::Vector3d areaVector(const SurfaceMesh& mesh, const SurfaceMesh::Triangle& triangle) {
  const Eigen::Vector3d& a = mesh.positions[triangle[0]];
  return 0.5 * (mesh.positions[triangle[1]] - a).cross(mesh.positions[triangle[2]] - a);
}

inline double areaOf(const SurfaceMesh& mesh, const std::vector<SurfaceMesh::Triangle>& triangles) {
  double area = 0.0;
  for (const auto& triangle : triangles) area += areaVector(mesh, triangle).norm();
  return area;
}

/// Seen from above.
inline double footprintOf(const SurfaceMesh& mesh, const std::vector<SurfaceMesh::Triangle>& triangles) {
  double area = 0.0;
  for (const auto& triangle : triangles) area += areaVector(mesh, triangle).z();
  return area;
}

/// Between the triangles and z = 0. [m³]
inline double volumeUnder(const SurfaceMesh& mesh, const std::vector<SurfaceMesh::Triangle>& triangles) {
  double volume = 0.0;
  for (const auto& triangle : triangles) {
    double height = 0.0;
    for (const std::uint32_t corner : triangle) height += mesh.positions[corner].z() / 3.0;
    volume += height * areaVector(mesh, triangle).z();
  }
  return volume;
}

/// Expects that errors shrink with the order, from grid to grid each twice as fine: over all of them.
inline void expectOrder(const std::vector<double>& errors, double order, const char* what) {
  const double measured = std::log2(errors.front() / errors.back()) / static_cast<double>(errors.size() - 1);
  std::cout << what << ": errors";
  for (const double error : errors) std::cout << " " << error;
  std::cout << ", order " << measured << std::endl;
  EXPECT_GE(measured, order) << what;
}

}  // namespace shallow_sand
