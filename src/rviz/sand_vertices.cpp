#include "shallow_sand/rviz/sand_vertices.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace shallow_sand {
namespace {

/// So much lies on a body that one sees it. [m]
constexpr float kVisibleLoad = 0.001f;
/// Sand thinner than this counts as bare bed (section 7.2 of the paper). [cells]
constexpr float kShore = 0.1f;
/// How high a sheet may rise from one cell to the next [cells]; what is steeper is no slope of sand.
constexpr float kSteepest = 3.0f;

/// Looks at a map's surface around a cell; beyond the sides it goes on as at them.
template <class Elevation>
class Surroundings {
 public:
  Surroundings(const HeightField& map, const Elevation& elevation) : map_(map), elevation_(elevation) {}

  float at(std::int64_t column, std::int64_t row) const {
    const auto i = std::clamp<std::int64_t>(column, 0, std::int64_t{map_.columns} - 1);
    const auto j = std::clamp<std::int64_t>(row, 0, std::int64_t{map_.rows} - 1);
    return elevation_(static_cast<std::size_t>(j) * map_.columns + static_cast<std::size_t>(i));
  }

  void setNormal(std::int64_t i, std::int64_t j, SandVertex& vertex) const {
    const auto slope = [&](float before, float after, bool one_sided) {
      return (after - before) / ((one_sided ? 1.0f : 2.0f) * map_.spacing);
    };
    const float x = slope(at(i - 1, j), at(i + 1, j), i == 0 || i + 1 == map_.columns);
    const float y = slope(at(i, j - 1), at(i, j + 1), j == 0 || j + 1 == map_.rows);
    const float length = std::sqrt(x * x + y * y + 1.0f);
    vertex.normal[0] = -x / length;
    vertex.normal[1] = -y / length;
    vertex.normal[2] = 1.0f / length;
  }

  /// Share of the sky above the horizon, from the steepest rise in eight directions.
  float openness(std::int64_t i, std::int64_t j) const {
    constexpr std::array<int, 3> kSteps{1, 3, static_cast<int>(kReachOfVertices)};
    const float own = at(i, j);
    float open = 0.0f;
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        if (dx == 0 && dy == 0) continue;
        float steepest = 0.0f;
        for (const int step : kSteps) {
          const float way =
              static_cast<float>(step) * map_.spacing * (dx != 0 && dy != 0 ? 1.41421356f : 1.0f);
          steepest = std::max(steepest, (at(i + step * dx, j + step * dy) - own) / way);
        }
        open += 1.0f - steepest / std::sqrt(1.0f + steepest * steepest);
      }
    }
    return open / 8.0f;
  }

 private:
  const HeightField& map_;
  const Elevation& elevation_;
};

/// Depth of the sand. Next to a shore the surface of the sand is thought to go on below the bed, so that the
/// line at which sand ends between cells lies where it should: without teeth.
float depthWithShore(const HeightField& map, std::int64_t i, std::int64_t j) {
  const auto cell = [&](std::int64_t column, std::int64_t row) {
    return static_cast<std::size_t>(row) * map.columns + static_cast<std::size_t>(column);
  };
  const auto isWet = [&](std::int64_t column, std::int64_t row) {
    return column >= 0 && row >= 0 && column < map.columns && row < map.rows &&
           map.depth[cell(column, row)] >= kShore * map.spacing;
  };
  const float own = map.depth[cell(i, j)];
  if (isWet(i, j)) return own;
  float highest = -std::numeric_limits<float>::infinity();
  for (std::int64_t dy = -1; dy <= 1; ++dy) {
    for (std::int64_t dx = -1; dx <= 1; ++dx) {
      if ((dx == 0 && dy == 0) || !isWet(i + dx, j + dy)) continue;
      const float next = groundElevation(map, cell(i + dx, j + dy));
      const bool has_slope = isWet(i + 2 * dx, j + 2 * dy);
      const float rise = has_slope ? next - groundElevation(map, cell(i + 2 * dx, j + 2 * dy)) : 0.0f;
      highest = std::max(highest, next + rise - map.bed[cell(i, j)]);
    }
  }
  return std::isfinite(highest) ? std::min(own, highest) : own;
}

float shownValue(const HeightField& map, std::size_t cell, const ShownValue& shown) {
  if (shown.kind == ShownValue::Kind::speed) return map.speed.empty() ? 0.0f : map.speed[cell];
  if (shown.kind == ShownValue::Kind::rise) return groundElevation(map, cell) - (*shown.start)[cell];
  return 0.0f;
}

void setPlace(const HeightField& map, std::uint32_t column, std::uint32_t row, float elevation,
              SandVertex& vertex) {
  vertex.position[0] = (static_cast<float>(column) + 0.5f) * map.spacing;
  vertex.position[1] = (static_cast<float>(row) + 0.5f) * map.spacing;
  vertex.position[2] = elevation;
}

bool hasLoad(const HeightField& map, std::size_t cell) { return map.load[cell] >= kVisibleLoad; }

float visibleElevation(const HeightField& map, std::size_t cell) {
  return hasLoad(map, cell) ? map.load_elevation[cell] + map.load[cell] : groundElevation(map, cell);
}

/// Calls function(column, row, cell) for the cells of a rectangle, row by row.
template <class Function>
void forEachCell(const HeightField& map, const CellRectangle& cells, const Function& function) {
  for (std::uint32_t row = cells.row; row < cells.row + cells.rows; ++row) {
    for (std::uint32_t column = cells.column; column < cells.column + cells.columns; ++column)
      function(column, row, std::size_t{row} * map.columns + column);
  }
}

}  // namespace

std::vector<SandVertex> groundVertices(const HeightField& map, const CellRectangle& cells,
                                       const ShownValue& shown) {
  const auto elevation = [&](std::size_t cell) { return groundElevation(map, cell); };
  const Surroundings surroundings(map, elevation);
  std::vector<SandVertex> vertices;
  vertices.reserve(std::size_t{cells.columns} * cells.rows);
  forEachCell(map, cells, [&](std::uint32_t column, std::uint32_t row, std::size_t cell) {
    SandVertex vertex;
    setPlace(map, column, row, elevation(cell), vertex);
    surroundings.setNormal(column, row, vertex);
    vertex.depth = depthWithShore(map, column, row);
    vertex.value = shownValue(map, cell, shown);
    vertex.openness = surroundings.openness(column, row);
    vertices.push_back(vertex);
  });
  return vertices;
}

std::vector<std::uint32_t> gridTriangles(std::uint32_t columns, std::uint32_t rows, std::uint32_t stride) {
  std::vector<std::uint32_t> corners;
  for (std::uint32_t row = 0; row + 1 < rows; row += stride) {
    const std::uint32_t south = row * columns;
    const std::uint32_t north = std::min(row + stride, rows - 1) * columns;
    for (std::uint32_t west = 0; west + 1 < columns; west += stride) {
      const std::uint32_t east = std::min(west + stride, columns - 1);
      corners.insert(corners.end(),
                     {south + west, south + east, north + east, south + west, north + east, north + west});
    }
  }
  return corners;
}

LoadSheet loadSheet(const HeightField& map, const CellRectangle& cells) {
  LoadSheet sheet;
  if (map.load.empty()) return sheet;
  bool any = false;
  forEachCell(map, cells, [&](std::uint32_t, std::uint32_t, std::size_t cell) { any |= hasLoad(map, cell); });
  if (!any) return sheet;

  const auto elevation = [&](std::size_t cell) { return visibleElevation(map, cell); };
  const Surroundings surroundings(map, elevation);
  std::vector<bool> loaded;
  forEachCell(map, cells, [&](std::uint32_t column, std::uint32_t row, std::size_t cell) {
    SandVertex vertex{};
    setPlace(map, column, row, elevation(cell), vertex);
    surroundings.setNormal(column, row, vertex);
    // The ground beside a load is none of it, but what is drawn of this sheet is sand.
    vertex.depth = std::max(map.load[cell], map.spacing);
    vertex.openness = 1.0f;
    loaded.push_back(hasLoad(map, cell));
    sheet.vertices.push_back(vertex);
  });
  const std::vector<std::uint32_t> all = gridTriangles(cells.columns, cells.rows, 1);
  for (std::size_t k = 0; k < all.size(); k += 3) {
    if (!loaded[all[k]] && !loaded[all[k + 1]] && !loaded[all[k + 2]]) continue;
    const auto height = [&](std::size_t corner) { return sheet.vertices[all[corner]].position[2]; };
    const auto [low, high] = std::minmax({height(k), height(k + 1), height(k + 2)});
    if (high - low > kSteepest * map.spacing) continue;
    sheet.triangles.insert(sheet.triangles.end(), {all[k], all[k + 1], all[k + 2]});
  }
  return sheet;
}

std::vector<SandVertex> sideVertices(const HeightField& map, Side side) {
  const bool along_x = side == Side::y_min || side == Side::y_max;
  const std::uint32_t column = side == Side::x_max ? map.columns - 1 : 0;
  const std::uint32_t row = side == Side::y_max ? map.rows - 1 : 0;
  std::vector<SandVertex> vertices;
  for (std::uint32_t k = 0; k < (along_x ? map.columns : map.rows); ++k) {
    const std::uint32_t i = along_x ? k : column;
    const std::uint32_t j = along_x ? row : k;
    const std::size_t cell = std::size_t{j} * map.columns + i;
    SandVertex vertex{};
    vertex.normal[0] = side == Side::x_min ? -1.0f : side == Side::x_max ? 1.0f : 0.0f;
    vertex.normal[1] = side == Side::y_min ? -1.0f : side == Side::y_max ? 1.0f : 0.0f;
    vertex.depth = map.depth[cell];
    vertex.openness = 1.0f;
    setPlace(map, i, j, groundElevation(map, cell), vertex);
    vertices.push_back(vertex);
    vertex.position[2] = map.bed[cell];
    vertices.push_back(vertex);
  }
  return vertices;
}

std::vector<std::uint32_t> sideTriangles(const HeightField& map, Side side) {
  const bool along_x = side == Side::y_min || side == Side::y_max;
  // Going up the numbers, the outside is on the right of these.
  const bool forwards = side == Side::y_min || side == Side::x_max;
  std::vector<std::uint32_t> corners;
  for (std::uint32_t k = 0; k + 1 < (along_x ? map.columns : map.rows); ++k) {
    const std::uint32_t top = 2 * k;
    const std::uint32_t bottom = top + 1;
    const std::uint32_t next_top = top + 2;
    const std::uint32_t next_bottom = top + 3;
    if (forwards) {
      corners.insert(corners.end(), {bottom, next_bottom, next_top, bottom, next_top, top});
    } else {
      corners.insert(corners.end(), {next_bottom, bottom, top, next_bottom, top, next_top});
    }
  }
  return corners;
}

}  // namespace shallow_sand
