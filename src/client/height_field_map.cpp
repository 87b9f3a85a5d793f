#include "shallow_sand/client/height_field_map.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace shallow_sand {
namespace {

/// More updates are not kept while a map is on its way: the map will hold what the oldest said.
constexpr std::size_t kMostWaiting = 4096;

struct NamedValues {
  const char* name;
  const std::vector<float>& values;
  bool may_be_missing;
};

/// What is wrong with lists of so many values; empty if nothing is.
std::string problemOf(const std::vector<NamedValues>& lists, std::uint64_t cells) {
  std::ostringstream problem;
  for (const auto& [name, values, may_be_missing] : lists) {
    if (values.empty() && may_be_missing) continue;
    if (values.size() != cells) {
      problem << name << " has " << values.size() << " values; expected " << cells << ", one a cell";
    } else if (!std::all_of(values.begin(), values.end(), [](float value) { return std::isfinite(value); })) {
      problem << name << " has values that are not finite; expected numbers";
    } else {
      continue;
    }
    return problem.str();
  }
  return {};
}

template <class Message>
std::uint64_t cellsOf(const Message& message) {
  return static_cast<std::uint64_t>(message.columns) * message.rows;
}

std::string problemOf(const HeightField& map) {
  if (map.columns == 0 || map.rows == 0 || !std::isfinite(map.spacing) || !(map.spacing > 0.0f) ||
      !std::isfinite(map.origin_x) || !std::isfinite(map.origin_y)) {
    std::ostringstream problem;
    problem << "grid of " << map.columns << " x " << map.rows << " cells of " << map.spacing << " m at ("
            << map.origin_x << ", " << map.origin_y << "); expected positive, finite numbers";
    return problem.str();
  }
  return problemOf({{"bed", map.bed, false},
                    {"depth", map.depth, false},
                    {"speed", map.speed, true},
                    {"load", map.load, true},
                    {"load_elevation", map.load_elevation, map.load.empty()}},
                   cellsOf(map));
}

std::string problemOf(const HeightFieldUpdate& update) {
  return problemOf({{"depth", update.depth, false},
                    {"speed", update.speed, true},
                    {"load", update.load, true},
                    {"load_elevation", update.load_elevation, update.load.empty()}},
                   cellsOf(update));
}

/// Puts a rectangle's values, or zeros if there are none, into those of the map.
void put(const std::vector<float>& values, const HeightFieldUpdate& update, std::uint32_t map_columns,
         std::vector<float>& map) {
  for (std::uint32_t row = 0; row < update.rows; ++row) {
    const auto into = map.begin() + static_cast<std::ptrdiff_t>(std::size_t{update.row + row} * map_columns +
                                                                update.column);
    const auto first = static_cast<std::ptrdiff_t>(std::size_t{row} * update.columns);
    if (values.empty()) {
      std::fill_n(into, update.columns, 0.0f);
    } else {
      std::copy_n(values.begin() + first, update.columns, into);
    }
  }
}

void put(const HeightFieldUpdate& update, HeightField& map) {
  put(update.depth, update, map.columns, map.depth);
  if (!map.speed.empty()) put(update.speed, update, map.columns, map.speed);
  if (map.load.empty() && !update.load.empty()) {
    map.load.assign(map.depth.size(), 0.0f);
    map.load_elevation.assign(map.depth.size(), 0.0f);
  }
  if (map.load.empty()) return;
  put(update.load, update, map.columns, map.load);
  put(update.load_elevation, update, map.columns, map.load_elevation);
}

bool isInside(const HeightFieldUpdate& update, const HeightField& map) {
  return std::uint64_t{update.column} + update.columns <= map.columns &&
         std::uint64_t{update.row} + update.rows <= map.rows;
}

}  // namespace

HeightFieldMap::Change HeightFieldMap::take(const HeightField& message) {
  Change change;
  change.refused = problemOf(message);
  if (!change.refused.empty()) return change;
  // A map that was sent before what is known already.
  if (field_ && field_->map == message.map && message.sequence < field_->sequence) return change;
  field_ = message;
  change.made_anew = true;
  applyWaiting(change);
  return change;
}

HeightFieldMap::Change HeightFieldMap::take(const HeightFieldUpdate& message) {
  Change change;
  change.refused = problemOf(message);
  if (!change.refused.empty()) return change;
  keepWaiting(message);
  if (field_) applyWaiting(change);
  return change;
}

void HeightFieldMap::keepWaiting(const HeightFieldUpdate& update) {
  waiting_.push_back(update);
  if (waiting_.size() > kMostWaiting) waiting_.pop_front();
}

void HeightFieldMap::applyWaiting(Change& change) {
  while (!waiting_.empty()) {
    const HeightFieldUpdate& update = waiting_.front();
    // Its map is still to come.
    if (update.map > field_->map) return;
    if (update.map == field_->map && update.sequence > field_->sequence) {
      const bool follows = update.sequence == field_->sequence + 1 && cellsOf(update) > 0;
      if (!follows) return;
      if (isInside(update, *field_)) {
        put(update, *field_);
        change.cells.push_back({update.column, update.row, update.columns, update.rows});
      } else {
        change.refused = "an update of cells outside of the map; expected cells of the map";
      }
      field_->sequence = update.sequence;
      field_->header = update.header;
    }
    waiting_.pop_front();
  }
}

}  // namespace shallow_sand
