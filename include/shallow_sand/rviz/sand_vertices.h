#pragma once

#include <cstdint>
#include <vector>

#include "shallow_sand/HeightField.h"
#include "shallow_sand/client/height_field_map.h"

namespace shallow_sand {

/// A corner of what is drawn, as it lies in the memory of the graphics card. Places are seen from the corner
/// of the map with the smallest x and y, in its frame. [m]
struct SandVertex {
  float position[3];
  float normal[3];
  float depth;     ///< of the sand [m]; negative where the surface beside it goes on below the bare bed
  float value;     ///< what colours may show: speed [m/s], or how much the surface has risen [m]
  float openness;  ///< how much of the sky the place sees, from 0 to 1: little in ruts
};

/// What SandVertex::value holds. `start` has the elevation of each cell to which a rise is measured.
struct ShownValue {
  enum class Kind { none, speed, rise };
  Kind kind = Kind::none;
  const std::vector<float>* start = nullptr;
};

/// How far a change of a cell is felt in the vertices around it. [cells]
constexpr std::uint32_t kReachOfVertices = 6;

/// Elevation of the ground's surface, s = h + b. [m]
inline float groundElevation(const HeightField& map, std::size_t cell) {
  return map.bed[cell] + map.depth[cell];
}

/// Of the ground, one at the centre of each cell of a rectangle, row by row.
std::vector<SandVertex> groundVertices(const HeightField& map, const CellRectangle& cells,
                                       const ShownValue& shown);

/// Triangles of a rectangle of vertices, row by row, between every `stride`-th of them and the last;
/// counter-clockwise seen from above.
std::vector<std::uint32_t> gridTriangles(std::uint32_t columns, std::uint32_t rows, std::uint32_t stride);

/// Sand on bodies, a sheet of its own: the triangles of a rectangle that have some at a corner, but none that
/// hang from it to the ground far below. Both are empty if there are none.
struct LoadSheet {
  std::vector<SandVertex> vertices;
  std::vector<std::uint32_t> triangles;
};
LoadSheet loadSheet(const HeightField& map, const CellRectangle& cells);

/// The cut through sand along the side of a map: a strip of vertices, by turns on the surface and on the bed.
enum class Side { x_min, x_max, y_min, y_max };
std::vector<SandVertex> sideVertices(const HeightField& map, Side side);
/// Triangles of such a strip, counter-clockwise seen from outside.
std::vector<std::uint32_t> sideTriangles(const HeightField& map, Side side);

}  // namespace shallow_sand
