#include "shallow_sand/ros/height_field_difference.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "shallow_sand/solver/equations.h"

namespace shallow_sand {
namespace {

/// Of the tiles in which changes are looked for [cells].
constexpr int kTile = 16;
/// Where more rectangles than this have changed, larger ones are sent: whoever follows keeps a few thousand.
constexpr std::size_t kMostRectangles = 256;
/// No rectangle takes more of the map's columns or rows than this part: what waits for a slow subscriber has
/// a bound.
constexpr int kParts = 8;

/// Numbers that are equal may differ in bits.
bool setBits(float& value, float to) {
  const bool changes = std::memcmp(&value, &to, sizeof value) != 0;
  value = to;
  return changes;
}

bool sameBits(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

}  // namespace

HeightFieldDifference::HeightFieldDifference(const Grid& grid, const std::string& frame,
                                             const SandConstants& sand, bool with_speed)
    : grid_(grid),
      sand_(sand),
      with_speed_(with_speed),
      changed_(grid, kTile, kTile),
      tiles_across_((grid.columns + kTile - 1) / kTile),
      changed_cells_(static_cast<std::size_t>(tiles_across_) *
                     static_cast<std::size_t>((grid.rows + kTile - 1) / kTile)) {
  map_.header.frame_id = frame;
  map_.columns = static_cast<std::uint32_t>(grid.columns);
  map_.rows = static_cast<std::uint32_t>(grid.rows);
  map_.spacing = grid.spacing;
  map_.origin_x = grid.origin_x;
  map_.origin_y = grid.origin_y;
}

HeightFieldDifference::News HeightFieldDifference::take(const FieldsChange& change, const ros::Time& stamp) {
  News news;
  map_.header.stamp = stamp;
  if (isWhole(change, grid_) && !sameBits(change.values.bed, map_.bed)) {
    makeMap(change);
    news.map_is_new = true;
    return news;
  }
  takeLoads(change);
  takeCells(change);
  for (const Window& cells : rectangles()) news.updates.push_back(updateOf(changedIn(cells)));
  std::fill(changed_cells_.begin(), changed_cells_.end(), Window{});
  return news;
}

void HeightFieldDifference::makeMap(const FieldsChange& change) {
  // A later map has a higher number, after a restart of the node, too.
  map_.map = std::max(map_.map + 1, static_cast<std::uint64_t>(ros::WallTime::now().toNSec()));
  map_.sequence = 0;
  map_.bed = change.values.bed;
  map_.depth = change.values.depth;
  map_.load = change.values.load;
  map_.load_elevation = change.values.load_elevation;
  if (!with_speed_) return;
  map_.speed.resize(map_.depth.size());
  for (std::size_t k = 0; k < map_.speed.size(); ++k) map_.speed[k] = speedOf(change.values, k);
}

void HeightFieldDifference::takeLoads(const FieldsChange& change) {
  if (change.values.load.empty() || !map_.load.empty()) return;
  map_.load.assign(map_.depth.size(), 0.0f);
  map_.load_elevation.assign(map_.depth.size(), 0.0f);
  // Whoever follows gets to know it from any update.
  const Window first{0, 0, 1, 1};
  changed_.add(first);
  changed_cells_[0] = first;
}

void HeightFieldDifference::takeCells(const FieldsChange& change) {
  const Fields& values = change.values;
  const bool with_loads = !values.load.empty();
  std::size_t k = 0;
  for (const Window& window : change.windows) {
    for (int j = window.row_begin; j < window.row_end; ++j) {
      for (int i = window.column_begin; i < window.column_end; ++i, ++k) {
        const std::size_t at = grid_.index(i, j);
        bool changes = setBits(map_.depth[at], values.depth[k]);
        if (with_speed_) changes |= setBits(map_.speed[at], speedOf(values, k));
        if (with_loads) {
          changes |= setBits(map_.load[at], values.load[k]);
          changes |= setBits(map_.load_elevation[at], values.load_elevation[k]);
        }
        if (!changes) continue;
        const Window cell{i, j, i + 1, j + 1};
        Window& cells = changed_cells_[static_cast<std::size_t>(j / kTile * tiles_across_ + i / kTile)];
        if (cells.empty()) changed_.add(cell);
        cells = cells.united(cell);
      }
    }
  }
}

float HeightFieldDifference::speedOf(const Fields& values, std::size_t k) const {
  return inverseDepth(values.depth[k], sand_) * std::hypot(values.momentum_x[k], values.momentum_y[k]);
}

std::vector<Window> HeightFieldDifference::rectangles() {
  int tile = kTile;
  const auto take = [&](TileSet& tiles) {
    return tiles.take(std::max(1, grid_.columns / kParts / tile), std::max(1, grid_.rows / kParts / tile));
  };
  std::vector<Window> rectangles = take(changed_);
  while (rectangles.size() > kMostRectangles) {
    tile *= 2;
    TileSet larger(grid_, tile, tile);
    for (const Window& cells : rectangles) larger.add(cells);
    rectangles = take(larger);
  }
  return rectangles;
}

Window HeightFieldDifference::changedIn(const Window& cells) const {
  Window changed;
  for (int row = cells.row_begin / kTile; row * kTile < cells.row_end; ++row) {
    for (int column = cells.column_begin / kTile; column * kTile < cells.column_end; ++column)
      changed = changed.united(changed_cells_[static_cast<std::size_t>(row * tiles_across_ + column)]);
  }
  return changed;
}

HeightFieldUpdate HeightFieldDifference::updateOf(const Window& cells) {
  ++map_.sequence;
  HeightFieldUpdate update = sequence();
  update.column = static_cast<std::uint32_t>(cells.column_begin);
  update.row = static_cast<std::uint32_t>(cells.row_begin);
  update.columns = static_cast<std::uint32_t>(cells.columns());
  update.rows = static_cast<std::uint32_t>(cells.rows());
  const auto copy = [&](const std::vector<float>& from, std::vector<float>& to) {
    if (from.empty()) return;
    to.reserve(cells.cells());
    appendCells(from, cells, grid_, to);
  };
  copy(map_.depth, update.depth);
  copy(map_.speed, update.speed);
  copy(map_.load, update.load);
  copy(map_.load_elevation, update.load_elevation);
  return update;
}

HeightFieldUpdate HeightFieldDifference::sequence() const {
  HeightFieldUpdate update;
  update.header = map_.header;
  update.map = map_.map;
  update.sequence = map_.sequence;
  return update;
}

}  // namespace shallow_sand
