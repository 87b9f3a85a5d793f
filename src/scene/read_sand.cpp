#include <algorithm>
#include <cmath>
#include <sstream>

#include "bounds.h"
#include "sand_layer.h"
#include "scene_reader.h"

namespace shallow_sand {
namespace {

SandLayer readBox(const SceneValue& box) {
  box.requireMap({"min", "max", "depth"});
  const Eigen::Vector2d minimum = box.at("min").vector<2>(bounds::finite);
  const Eigen::Vector2d maximum = box.at("max").vector<2>(bounds::finite);
  if ((maximum.array() <= minimum.array()).any()) {
    box.at("max").fail("a corner with x and y above those of min");
  }
  return boxLayer(minimum, maximum, box.at("depth").number(bounds::finite));
}

SandLayer readCylinder(const SceneValue& cylinder) {
  cylinder.requireMap({"center", "radius", "depth"});
  return cylinderLayer(cylinder.at("center").vector<2>(bounds::finite),
                       cylinder.at("radius").number(bounds::positive),
                       cylinder.at("depth").number(bounds::finite));
}

SandLayer readCone(const SceneValue& cone) {
  cone.requireMap({"center", "height", "slope_angle"});
  return coneLayer(cone.at("center").vector<2>(bounds::finite), cone.at("height").number(bounds::positive),
                   std::tan(radians(cone.at("slope_angle").number(bounds::slope_angle))));
}

SandLayer readFile(const SceneValue& entry, const Grid& grid) {
  std::vector<float> values = readTerrain(entry, grid, {"as"});
  const SceneValue as = entry.at("as");
  if (!as.is("surface") && !as.is("depth")) {
    as.fail("surface or depth");
  }
  return as.is("surface") ? fillToSurfaces(std::move(values)) : unevenLayer(std::move(values));
}

SandLayer readLayer(const SceneValue& entry, const Grid& grid) {
  if (entry.find("file")) {
    return readFile(entry, grid);
  }
  const std::string kind = entry.requireOneOf({"depth", "surface", "cylinder", "box", "cone", "file"});
  const SceneValue value = entry.at(kind);
  if (kind == "depth") {
    return evenLayer(value.number(bounds::finite));
  }
  if (kind == "surface") {
    return fillToSurface(value.number(bounds::finite));
  }
  if (kind == "cylinder") {
    return readCylinder(value);
  }
  return kind == "box" ? readBox(value) : readCone(value);
}

[[noreturn]] void failNegative(const SceneValue& entry, const Eigen::Vector2d& centre, double before,
                               double after) {
  std::ostringstream found;
  found << "takes " << before - after << " m away at (" << centre.x() << ", " << centre.y() << ")";
  std::ostringstream expected;
  expected << "at most the " << before << " m of sand that lie there";
  entry.fail(found.str(), expected.str());
}

/// Depth of the sand at one cell after all layers. Sums that should be nothing may miss it by rounding.
double depthAt(const Column& column, const std::vector<SandLayer>& layers,
               const std::vector<SceneValue>& entries) {
  constexpr double rounding = 1e-9;
  double depth = 0.0;
  for (std::size_t k = 0; k < layers.size(); ++k) {
    const double next = layers[k](column, depth);
    if (next < -rounding) {
      failNegative(entries[k], column.centre, depth, next);
    }
    depth = std::max(0.0, next);
  }
  return depth;
}

}  // namespace

std::vector<float> readBed(const SceneValue& root, const Grid& grid) {
  double elevation = 0.0;
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();
  if (const auto bed = root.find("bed")) {
    if (bed->find("file")) {
      return readTerrain(*bed, grid);
    }
    bed->requireMap({"elevation", "slope", "file"});
    bed->read("elevation", bounds::finite, elevation);
    bed->read("slope", bounds::finite, slope);
  }
  std::vector<float> elevations(grid.cells());
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      elevations[grid.index(i, j)] =
          static_cast<float>(elevation + slope.x() * grid.x(i) + slope.y() * grid.y(j));
    }
  }
  return elevations;
}

std::vector<float> readSand(const SceneValue& root, const Grid& grid, const std::vector<float>& bed) {
  std::vector<float> depth(grid.cells(), 0.0f);
  const auto list = root.find("sand");
  if (!list) {
    return depth;
  }
  const std::vector<SceneValue> entries = list->items();
  std::vector<SandLayer> layers;
  std::transform(entries.begin(), entries.end(), std::back_inserter(layers),
                 [&grid](const SceneValue& entry) { return readLayer(entry, grid); });
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      const std::size_t cell = grid.index(i, j);
      const Column column{cell, {grid.x(i), grid.y(j)}, static_cast<double>(bed[cell])};
      depth[cell] = static_cast<float>(depthAt(column, layers, entries));
    }
  }
  return depth;
}

}  // namespace shallow_sand
