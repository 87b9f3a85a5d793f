#include "shallow_sand/rviz/sand_ray.h"

#include <OGRE/OgreAxisAlignedBox.h>

#include <algorithm>
#include <cmath>

#include "shallow_sand/rviz/sand_vertices.h"

namespace shallow_sand {
namespace {

Ogre::AxisAlignedBox boxOf(const HeightField& map) {
  float low = groundElevation(map, 0);
  float high = low;
  for (std::size_t cell = 1; cell < map.depth.size(); ++cell) {
    low = std::min(low, groundElevation(map, cell));
    high = std::max(high, groundElevation(map, cell));
  }
  const Ogre::Vector3 corner(static_cast<Ogre::Real>(map.origin_x), static_cast<Ogre::Real>(map.origin_y),
                             low);
  const float spacing = map.spacing;
  // A box without height is met by no ray along it.
  const Ogre::Vector3 size(static_cast<float>(map.columns) * spacing, static_cast<float>(map.rows) * spacing,
                           high - low + spacing);
  return {corner, corner + size};
}

}  // namespace

float elevationAt(const HeightField& map, float x, float y) {
  const auto cellsFrom = [&](float position, double origin, std::uint32_t cells) {
    const float place = (position - static_cast<float>(origin)) / map.spacing - 0.5f;
    return std::clamp(place, 0.0f, static_cast<float>(cells - 1));
  };
  const float column = cellsFrom(x, map.origin_x, map.columns);
  const float row = cellsFrom(y, map.origin_y, map.rows);
  const auto i = static_cast<std::size_t>(column);
  const auto j = static_cast<std::size_t>(row);
  const std::size_t east = std::min<std::size_t>(i + 1, map.columns - 1);
  const std::size_t north = std::min<std::size_t>(j + 1, map.rows - 1);
  const float a = column - static_cast<float>(i);
  const float b = row - static_cast<float>(j);
  const auto at = [&](std::size_t k, std::size_t l) { return groundElevation(map, l * map.columns + k); };
  return (1.0f - b) * ((1.0f - a) * at(i, j) + a * at(east, j)) +
         b * ((1.0f - a) * at(i, north) + a * at(east, north));
}

std::optional<float> meetSand(const HeightField& map, const Ogre::Ray& ray) {
  const Ogre::AxisAlignedBox box = boxOf(map);
  const auto [met, near_distance] = ray.intersects(box);
  const float speed = std::hypot(ray.getDirection().x, ray.getDirection().y);
  const float length = ray.getDirection().length();
  if (!met || !(length > 0.0f)) return std::nullopt;
  const auto above = [&](float distance) {
    const Ogre::Vector3 point = ray.getPoint(distance);
    return point.z - elevationAt(map, point.x, point.y);
  };
  // Half a cell on the ground a step, no more than half a cell in all where the ray is steep.
  const float step = 0.5f * map.spacing / std::max(speed, 0.25f * length);
  // However large and far away, a map is crossed in so many.
  const int most_steps = 8 * static_cast<int>(map.columns + map.rows);
  const float begin = std::max(near_distance, 0.0f);
  if (above(begin) < 0.0f) return std::nullopt;  // comes from below
  float before = begin;
  for (int k = 1; k <= most_steps; ++k) {
    const float after = begin + static_cast<float>(k) * step;
    if (above(after) < 0.0f) {
      float outside = before;
      float inside = after;
      for (int halving = 0; halving < 20; ++halving) {
        const float middle = 0.5f * (outside + inside);
        (above(middle) < 0.0f ? inside : outside) = middle;
      }
      const Ogre::Vector3 point = ray.getPoint(outside);
      const bool over_map = point.x >= box.getMinimum().x && point.x <= box.getMaximum().x &&
                            point.y >= box.getMinimum().y && point.y <= box.getMaximum().y;
      return over_map ? std::optional<float>(outside) : std::nullopt;
    }
    before = after;
  }
  return std::nullopt;
}

}  // namespace shallow_sand
