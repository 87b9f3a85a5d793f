#include "shallow_sand/surface/polygon_volume.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "shallow_sand/core/parameters.h"
#include "shallow_sand/device/window.h"

namespace shallow_sand {
namespace {

using Corners = std::vector<Eigen::Vector2d>;

std::string toText(const Eigen::Vector2d& corner) {
  std::ostringstream text;
  text << "(" << corner.x() << ", " << corner.y() << ")";
  return text.str();
}

/// Shares of cells in a polygon. What lies to the right of a side, seen along x, is counted as within by its
/// rise, and what lies to the right of a side that falls, as without; the sums along a row are the shares.
class Shares {
 public:
  /// @param window of cells that the polygon may touch; sides are relative to its corner, in cells
  explicit Shares(const Window& window)
      : columns_(window.columns()),
        rows_(window.rows()),
        in_column_(window.cells(), 0.0),
        from_column_on_(window.cells(), 0.0) {}

  void addSide(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
    const double low = std::clamp(std::min(from.y(), to.y()), 0.0, static_cast<double>(rows_));
    const double high = std::clamp(std::max(from.y(), to.y()), 0.0, static_cast<double>(rows_));
    for (int row = static_cast<int>(low); row < high; ++row) {
      const double begin = std::max(low, static_cast<double>(row));
      const double end = std::min(high, row + 1.0);
      const double x_begin = xAt(from, to, begin);
      const double x_end = xAt(from, to, end);
      addInRow(row, {x_begin, begin}, {x_end, end}, to.y() > from.y() ? 1.0 : -1.0);
    }
  }

  /// Calls function(column, row, share) for all cells that are partly within.
  template <class Function>
  void forEach(const Function& function) const {
    for (int row = 0; row < rows_; ++row) {
      double sum = 0.0;
      for (int column = 0; column < columns_; ++column) {
        const std::size_t at = index(column, row);
        sum += from_column_on_[at];
        const double share = sum + in_column_[at];
        if (share != 0.0) function(column, row, share);
      }
    }
  }

 private:
  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }
  static double xAt(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double y) {
    if (y == from.y()) return from.x();
    if (y == to.y()) return to.x();
    return from.x() + (to.x() - from.x()) * ((y - from.y()) / (to.y() - from.y()));
  }

  /// A piece of a side within a row; `low` and `high` by y.
  void addInRow(int row, const Eigen::Vector2d& low, const Eigen::Vector2d& high, double sign) {
    const Eigen::Vector2d& left = low.x() <= high.x() ? low : high;
    const Eigen::Vector2d& right = low.x() <= high.x() ? high : low;
    const double rise = high.y() - low.y();
    const double width = right.x() - left.x();
    // The rise of the part of it that lies between two places along x.
    const auto riseOf = [&](double begin, double end) {
      return width > 0.0 ? sign * rise * ((end - begin) / width) : sign * rise;
    };
    const double edge = static_cast<double>(columns_);
    if (left.x() < 0.0) from_column_on_[index(0, row)] += riseOf(left.x(), std::min(right.x(), 0.0));
    if (right.x() < 0.0 || left.x() >= edge) return;
    const double first = std::max(left.x(), 0.0);
    const double last = std::min(right.x(), edge);
    int column = static_cast<int>(first);
    double begin = first;
    do {
      const double end = std::min(last, column + 1.0);
      addInCell(column, row, riseOf(begin, end), 0.5 * (begin + end));
      begin = end;
      ++column;
    } while (column < last && column < columns_);
  }

  void addInCell(int column, int row, double rise, double middle) {
    in_column_[index(column, row)] += rise * (column + 1.0 - middle);
    if (column + 1 < columns_) from_column_on_[index(column + 1, row)] += rise;
  }

  int columns_;
  int rows_;
  std::vector<double> in_column_;       // what a cell has of sides in it
  std::vector<double> from_column_on_;  // what it and all to the right have of sides to the left
};

Window windowOf(const Grid& grid, const Corners& corners) {
  Eigen::Vector2d low = corners.front();
  Eigen::Vector2d high = corners.front();
  for (const Eigen::Vector2d& corner : corners) {
    low = low.cwiseMin(corner);
    high = high.cwiseMax(corner);
  }
  const Eigen::Vector2d origin(grid.origin_x, grid.origin_y);
  low -= origin;
  high -= origin;
  return Window::around(low.x(), low.y(), high.x(), high.y(), grid);
}

void requireNumber(const Eigen::Vector2d& corner) {
  constexpr double kFarthest = 1e8;  // UTM counts up to 1e7
  if ((corner.array().abs() <= kFarthest).all()) return;
  throw InvalidParameter("polygon", "corner " + toText(corner), "metres, at most a hundred million");
}

/// Twice the area of a triangle; positive if its corners are counter-clockwise.
double turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  const Eigen::Vector2d to_b = b - a;
  const Eigen::Vector2d to_c = c - a;
  return to_b.x() * to_c.y() - to_b.y() * to_c.x();
}

struct Side {
  Eigen::Vector2d from;
  Eigen::Vector2d to;

  Eigen::Vector2d low() const { return from.cwiseMin(to); }
  Eigen::Vector2d high() const { return from.cwiseMax(to); }

  bool meets(const Side& other) const {
    if ((low().array() > other.high().array()).any() || (other.low().array() > high().array()).any())
      return false;
    return !apart(turn(from, to, other.from), turn(from, to, other.to)) &&
           !apart(turn(other.from, other.to, from), turn(other.from, other.to, to));
  }
  /// Whether the next side goes back on this one.
  bool foldsInto(const Side& next) const {
    return turn(from, to, next.to) == 0.0 && (to - from).dot(next.to - next.from) < 0.0;
  }

 private:
  /// Whether two ends lie on one side of a line.
  static bool apart(double a, double b) { return (a > 0.0 && b > 0.0) || (a < 0.0 && b < 0.0); }
};

/// Those that have a length.
std::vector<Side> sidesOf(const Corners& corners) {
  std::vector<Side> sides;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Side side{corners[k], corners[(k + 1) % corners.size()]};
    if (side.from != side.to) sides.push_back(side);
  }
  return sides;
}

}  // namespace

void requireSimplePolygon(const std::vector<Eigen::Vector2d>& corners) {
  constexpr std::size_t kMostCorners = 10000;
  const std::vector<Side> sides = corners.size() > kMostCorners ? std::vector<Side>() : sidesOf(corners);
  if (sides.size() < 3) {
    throw InvalidParameter("polygon", std::to_string(corners.size()) + " corners",
                           "from 3 to " + std::to_string(kMostCorners) + " that differ");
  }
  for (const Eigen::Vector2d& corner : corners) requireNumber(corner);
  for (std::size_t k = 0; k < sides.size(); ++k) {
    for (std::size_t other = k + 1; other < sides.size(); ++other) {
      const bool follows = other == k + 1;
      const bool goes_before = k == 0 && other + 1 == sides.size();
      const bool problem = follows       ? sides[k].foldsInto(sides[other])
                           : goes_before ? sides[other].foldsInto(sides[k])
                                         : sides[k].meets(sides[other]);
      if (!problem) continue;
      throw InvalidParameter("polygon",
                             "the side from " + toText(sides[k].from) + " to " + toText(sides[k].to) +
                                 " meets that from " + toText(sides[other].from) + " to " +
                                 toText(sides[other].to),
                             "sides that meet the next one only, at their common corner");
    }
  }
}

PolygonVolume volumeInPolygon(const Grid& grid, const Fields& fields,
                              const std::vector<Eigen::Vector2d>& corners) {
  const Window window = windowOf(grid, corners);
  if (window.empty()) return {};
  const Eigen::Vector2d origin(grid.origin_x, grid.origin_y);
  const Eigen::Vector2d begin(window.column_begin, window.row_begin);
  const auto inCells = [&](const Eigen::Vector2d& corner) -> Eigen::Vector2d {
    return (corner - origin) / static_cast<double>(grid.spacing) - begin;
  };
  Shares shares(window);
  for (std::size_t k = 0; k < corners.size(); ++k)
    shares.addSide(inCells(corners[k]), inCells(corners[(k + 1) % corners.size()]));
  PolygonVolume volume;
  shares.forEach([&](int column, int row, double share) {
    const std::size_t cell = grid.index(window.column_begin + column, window.row_begin + row);
    volume.area += share;
    volume.on_ground += share * static_cast<double>(fields.depth[cell]);
    if (!fields.load.empty()) volume.on_bodies += share * static_cast<double>(fields.load[cell]);
  });
  // Of a polygon whose corners follow the clock's hands all shares are negative.
  const double cell_area = volume.area < 0.0 ? -grid.cellArea() : grid.cellArea();
  return {cell_area * volume.on_ground, cell_area * volume.on_bodies, cell_area * volume.area};
}

}  // namespace shallow_sand
