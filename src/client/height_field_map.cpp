#include "shallow_sand/client/height_field_map.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <sstream>

namespace shallow_sand {
namespace {

/// More updates, or updates of more cells (256 MiB of depths), are not kept while a map is on its way: the
/// map will hold what the oldest said.
constexpr std::size_t kMostWaiting = 4096;
constexpr std::uint64_t kMostWaitingCells = std::uint64_t{1} << 26;

struct NamedValues {
  const char* name;
  const std::vector<float>& values;
  bool may_be_missing;
};

/// Larger numbers are no metres, and sums of them no numbers.
bool isReasonable(double value) { return std::abs(value) <= 1e9; }

/// What is wrong with lists of so many values; empty if nothing is.
std::string problemOf(const std::vector<NamedValues>& lists, std::uint64_t cells) {
  std::ostringstream problem;
  for (const auto& [name, values, may_be_missing] : lists) {
    if (values.empty() && may_be_missing) continue;
    if (values.size() != cells) {
      problem << name << " has " << values.size() << " values; expected " << cells << ", one a cell";
    } else if (!std::all_of(values.begin(), values.end(), isReasonable)) {
      problem << name << " has values that are no numbers or above 1e9; expected numbers";
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
  if (map.columns == 0 || map.rows == 0 || !isReasonable(static_cast<double>(map.spacing)) ||
      !(map.spacing > 0.0f) || !isReasonable(map.origin_x) || !isReasonable(map.origin_y)) {
    std::ostringstream problem;
    problem << "grid of " << map.columns << " x " << map.rows << " cells of " << map.spacing << " m at ("
            << map.origin_x << ", " << map.origin_y
            << "); expected cells of a positive length, and numbers up to 1e9";
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

/// A rectangle that holds all cells in which two maps of the same size differ in any bit; empty if they do
/// not.
CellRectangle difference(const HeightField& a, const HeightField& b) {
  std::uint32_t first_column = a.columns;
  std::uint32_t last_column = 0;
  std::uint32_t first_row = a.rows;
  std::uint32_t last_row = 0;
  for (const auto values : {&HeightField::bed, &HeightField::depth, &HeightField::speed, &HeightField::load,
                            &HeightField::load_elevation}) {
    const std::vector<float>& here = a.*values;
    const std::vector<float>& there = b.*values;
    for (std::size_t cell = 0; cell < here.size(); ++cell) {
      if (std::memcmp(&here[cell], &there[cell], sizeof(float)) == 0) continue;
      first_column = std::min(first_column, static_cast<std::uint32_t>(cell % a.columns));
      last_column = std::max(last_column, static_cast<std::uint32_t>(cell % a.columns));
      first_row = std::min(first_row, static_cast<std::uint32_t>(cell / a.columns));
      last_row = std::max(last_row, static_cast<std::uint32_t>(cell / a.columns));
    }
  }
  if (first_row > last_row) return {0, 0, 0, 0};
  return {first_column, first_row, last_column - first_column + 1, last_row - first_row + 1};
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
  if (field_ && field_->map == message.map && message.sequence < field_->sequence) {
    // It may have been overtaken by updates, or a recording begins anew: what comes next will tell.
    earlier_ = message;
    return change;
  }
  replace(message, change);
  return change;
}

HeightFieldMap::Change HeightFieldMap::take(const HeightFieldUpdate& message) {
  Change change;
  change.refused = problemOf(message);
  if (!change.refused.empty()) {
    missing_ = true;
    return change;
  }
  const bool begins_anew = earlier_ && message.map == earlier_->map && cellsOf(message) > 0 &&
                           message.sequence == earlier_->sequence + 1;
  if (begins_anew) {
    const HeightField map = *earlier_;
    replace(map, change);
  }
  keepWaiting(message);
  if (field_) applyWaiting(change);
  return change;
}

void HeightFieldMap::replace(const HeightField& message, Change& change) {
  const bool is_same_map = field_ && field_->map == message.map && field_->columns == message.columns &&
                           field_->rows == message.rows && field_->load.size() == message.load.size() &&
                           field_->speed.size() == message.speed.size();
  if (is_same_map) {
    const CellRectangle cells = difference(*field_, message);
    if (cells.columns > 0) change.cells.push_back(cells);
  }
  change.made_anew = !is_same_map;
  field_ = message;
  earlier_.reset();
  missing_ = false;
  applyWaiting(change);
}

void HeightFieldMap::keepWaiting(const HeightFieldUpdate& update) {
  waiting_.push_back(update);
  waiting_cells_ += cellsOf(update);
  while (waiting_.size() > kMostWaiting || (waiting_.size() > 1 && waiting_cells_ > kMostWaitingCells))
    dropOldestWaiting();
}

void HeightFieldMap::dropOldestWaiting() {
  waiting_cells_ -= cellsOf(waiting_.front());
  waiting_.pop_front();
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
        missing_ = true;
      }
      field_->sequence = update.sequence;
      field_->header = update.header;
    }
    dropOldestWaiting();
  }
}

}  // namespace shallow_sand
