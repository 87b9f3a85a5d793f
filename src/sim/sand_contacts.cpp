#include "shallow_sand/sim/sand_contacts.h"

#include <algorithm>
#include <limits>

#include "shallow_sand/coupling/rays_together.h"
#include "shallow_sand/solver/equations.h"

namespace shallow_sand {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// A column that a body covers. Elevations [m].
struct CoveredColumn {
  int i;
  int j;
  double bottom;  ///< of the body's lowest point
  double top;
  std::size_t first_part;
  bool touched_below = false;  ///< sand fills the room under it
  double load = 0.0;           ///< depth of the sand that lies on the body [m]
  double load_foot = 0.0;      ///< where that lies
};

/// All columns of a body.
struct CoveredColumns {
  std::vector<CoveredColumn> columns;
  std::vector<SolidInterval> parts;  ///< of the body, column by column

  void add(int i, int j, const SolidInterval& part) {
    if (columns.empty() || columns.back().i != i || columns.back().j != j)
      columns.push_back({i, j, kInfinite, -kInfinite, parts.size()});
    CoveredColumn& column = columns.back();
    column.bottom = std::min(column.bottom, static_cast<double>(part.bottom));
    column.top = std::max(column.top, static_cast<double>(part.top));
    parts.push_back(part);
  }
  /// Length of the body in a column below an elevation. [m]
  double lengthBelow(double elevation, std::size_t column) const {
    const std::size_t end = column + 1 < columns.size() ? columns[column + 1].first_part : parts.size();
    double length = 0.0;
    for (std::size_t k = columns[column].first_part; k < end; ++k)
      length += std::max(std::min(static_cast<double>(parts[k].top), elevation) - parts[k].bottom, 0.0);
    return length;
  }
};

/// The sand, and where all bodies are in it.
class SandAndBodies {
 public:
  SandAndBodies(const Grid& grid, const Fields& fields, std::size_t bodies)
      : grid(grid), fields(fields), bodies(bodies), closed_(grid.cells(), false) {}

  /// Takes what the ray of a column found.
  void add(int i, int j, const SolidIntervals& solids) {
    if (solids.count == 0) return;
    for (int k = 0; k < solids.count; ++k) bodyOf(solids.at[k]).add(i, j, solids.at[k]);
    const LowestSolid solid = lowestSolid(solids, grid.spacing);
    addGround(i, j, solid);
    if (!fields.load.empty()) addLoad(i, j, solid, solids);
  }

  bool isOnGrid(int i, int j) const { return i >= 0 && i < grid.columns && j >= 0 && j < grid.rows; }
  /// Whether a body touches the ground's sand.
  bool isClosed(int i, int j) const { return closed_[grid.index(i, j)]; }
  /// Where the ground's sand ends. [m]
  double ground(int i, int j) const {
    const std::size_t cell = grid.index(i, j);
    return static_cast<double>(fields.bed[cell]) + static_cast<double>(fields.depth[cell]);
  }

  const Grid& grid;
  const Fields& fields;
  std::vector<CoveredColumns> bodies;

 private:
  void addGround(int i, int j, const LowestSolid& solid) {
    const std::size_t cell = grid.index(i, j);
    const float depth = fields.depth[cell];
    if (!isFull(depth, std::max(solid.bottom - fields.bed[cell], 0.0f), grid.spacing)) return;
    closed_[cell] = true;
    if (depth >= Fields::kDust) lastColumn(solid.lowest_body).touched_below = true;
  }
  void addLoad(int i, int j, const LowestSolid& solid, const SolidIntervals& solids) {
    const float load = fields.load[grid.index(i, j)];
    CoveredColumn& under = lastColumn(solid.highest_body);
    under.load = static_cast<double>(load);
    under.load_foot = static_cast<double>(solid.top);
    if (!(load >= Fields::kDust) || !isFull(load, solid.next - solid.top, grid.spacing)) return;
    for (int k = 0; k < solids.count; ++k) {
      if (solids.at[k].bottom == solid.next) lastColumn(solids.at[k].body).touched_below = true;
    }
  }
  CoveredColumns& bodyOf(const SolidInterval& part) { return bodies[static_cast<std::size_t>(part.body)]; }
  /// The one that was added last; it must be of this column.
  CoveredColumn& lastColumn(int body) { return bodies[static_cast<std::size_t>(body)].columns.back(); }

  std::vector<bool> closed_;
};

/// Called with what the ray of each column found.
struct AddColumn : BodiesOverBed {
  SandAndBodies* all;

  void operator()(int i, int j, const SolidIntervals& solids) const { all->add(i, j, solids); }
};

/// One body and the sand around it; see SandContact.
class BodyInSand {
 public:
  /// @param window all columns of the body, and perhaps others
  BodyInSand(const SandAndBodies& all, const CoveredColumns& body, const Window& window)
      : all_(all), body_(body), window_(window), bottom_(window.cells(), kInfinite), around_(window.cells()) {
    for (const CoveredColumn& column : body.columns) bottom_[at(column.i, column.j)] = column.bottom;
    for (int j = window.row_begin; j < window.row_end; ++j) {
      look(window.column_begin, j, 1, 0, window.columns());
      look(window.column_end - 1, j, -1, 0, window.columns());
    }
    for (int i = window.column_begin; i < window.column_end; ++i) {
      look(i, window.row_begin, 0, 1, window.rows());
      look(i, window.row_end - 1, 0, -1, window.rows());
    }
  }

  SandContact contact() const {
    SandContact contact;
    std::size_t touching = 0;
    for (std::size_t k = 0; k < body_.columns.size(); ++k) {
      const CoveredColumn& column = body_.columns[k];
      const std::size_t cell = all_.grid.index(column.i, column.j);
      const double surface = around_[at(column.i, column.j)].surface();
      contact.submerged_volume += body_.lengthBelow(surface, k);
      contact.carried_volume += column.load;
      if (column.load > 0.0) {
        contact.contact_momentum +=
            Eigen::Vector2d(all_.fields.load_momentum_x[cell], all_.fields.load_momentum_y[cell]);
      }
      const bool lies = column.load >= static_cast<double>(Fields::kDust);
      const bool reached = column.touched_below || isStoodAgainst(column);
      if (!lies && !reached) continue;
      const double low = reached ? column.bottom : column.load_foot;
      const double high = lies ? column.load_foot : std::max(low, std::min(column.top, surface));
      contact.contact_center +=
          Eigen::Vector3d(all_.grid.x(column.i), all_.grid.y(column.j), 0.5 * (low + high));
      touching += 1;
    }
    contact.contact_momentum += momentumBeside();
    const double area = all_.grid.cellArea();
    contact.submerged_volume *= area;
    contact.carried_volume *= area;
    contact.contact_momentum *= area;
    contact.touching_area = static_cast<double>(touching) * area;
    if (touching > 0) contact.contact_center /= static_cast<double>(touching);
    return contact;
  }

 private:
  /// What was found around a column.
  struct Around {
    double weight = 0.0;
    double sum = 0.0;  ///< of weighted elevations
    bool has_sand = false;
    double surface() const { return has_sand ? sum / weight : -kInfinite; }
  };

  std::size_t at(int i, int j) const {
    return static_cast<std::size_t>(j - window_.row_begin) * static_cast<std::size_t>(window_.columns()) +
           static_cast<std::size_t>(i - window_.column_begin);
  }
  bool covers(int i, int j) const { return window_.holds(i, j) && bottom_[at(i, j)] < kInfinite; }
  /// Whether the ground's sand in a cell of the grid is sand around the body.
  bool isAround(int i, int j) const { return !covers(i, j) && !all_.isClosed(i, j); }

  /// Goes through cells of the window, from (i, j) at its edge on, and tells each which sand lies behind.
  void look(int i, int j, int step_i, int step_j, int count) {
    int back_i = i - step_i;
    int back_j = j - step_j;
    int distance = 1;
    for (; all_.isOnGrid(back_i, back_j) && !isAround(back_i, back_j); ++distance) {
      back_i -= step_i;
      back_j -= step_j;
    }
    bool found = all_.isOnGrid(back_i, back_j);
    for (int k = 0; k < count; ++k, i += step_i, j += step_j, ++distance) {
      if (isAround(i, j)) {
        back_i = i;
        back_j = j;
        distance = 0;
        found = true;
      } else if (found && covers(i, j)) {
        Around& around = around_[at(i, j)];
        around.weight += 1.0 / distance;
        around.sum += all_.ground(back_i, back_j) / distance;
        around.has_sand =
            around.has_sand || all_.fields.depth[all_.grid.index(back_i, back_j)] >= bareDepth(all_.grid);
      }
    }
  }

  /// Whether sand in (i, j) stands higher than what is beside it.
  bool standsOver(int i, int j, double bottom) const {
    constexpr float kDust = Fields::kDust;
    return all_.isOnGrid(i, j) && isAround(i, j) && all_.fields.depth[all_.grid.index(i, j)] >= kDust &&
           all_.ground(i, j) - bottom >= static_cast<double>(kDust);
  }
  bool isStoodAgainst(const CoveredColumn& column) const {
    const int i = column.i;
    const int j = column.j;
    return standsOver(i - 1, j, column.bottom) || standsOver(i + 1, j, column.bottom) ||
           standsOver(i, j - 1, column.bottom) || standsOver(i, j + 1, column.bottom);
  }
  double bottomAt(int i, int j) const { return window_.holds(i, j) ? bottom_[at(i, j)] : kInfinite; }

  /// Of the columns that stand against the body, times ΔL⁻². [m²/s]
  Eigen::Vector2d momentumBeside() const {
    Eigen::Vector2d momentum(0.0, 0.0);
    const Window wide = window_.grown(1, all_.grid);
    for (int j = wide.row_begin; j < wide.row_end; ++j) {
      for (int i = wide.column_begin; i < wide.column_end; ++i) {
        const double lowest = std::min(std::min(bottomAt(i - 1, j), bottomAt(i + 1, j)),
                                       std::min(bottomAt(i, j - 1), bottomAt(i, j + 1)));
        if (!(lowest < kInfinite) || !standsOver(i, j, lowest)) continue;
        const std::size_t cell = all_.grid.index(i, j);
        momentum += Eigen::Vector2d(all_.fields.momentum_x[cell], all_.fields.momentum_y[cell]);
      }
    }
    return momentum;
  }

  const SandAndBodies& all_;
  const CoveredColumns& body_;
  Window window_;
  std::vector<double> bottom_;  ///< of the body; infinite where it is not
  std::vector<Around> around_;
};

}  // namespace

std::vector<SandContact> sandContacts(const Grid& grid, const Fields& fields,
                                      const std::vector<PlacedBody>& bodies, InstructionSet instructions) {
  const RaysTogether rays(instructions);
  std::vector<BodyView> views;
  std::vector<Window> windows;
  for (const PlacedBody& body : bodies) {
    views.push_back(body.view);
    windows.push_back(body.window);
  }
  windows = withoutOverlap(windows);
  const BinLists lists = binLists(bodies, windows);
  SandAndBodies all(grid, fields, bodies.size());
  const HostExecutor one_thread(1);
  HostExecutor::Memory<float> bed(grid.cells());  // has the room that rays want, and is filled where they are
  for (std::size_t k = 0; k < windows.size(); ++k) {
    for (int j = windows[k].row_begin; j < windows[k].row_end; ++j) {
      const std::size_t begin = grid.index(windows[k].column_begin, j);
      std::copy_n(fields.bed.data() + begin, windows[k].columns(), bed.data() + begin);
    }
    const BodyBins bins{views.data(), lists.first.data() + lists.first_begins[k], lists.members.data(),
                        windows[k], lists.across[k]};
    rays.forEachColumn(one_thread, AddColumn{{bins, bed.data(), grid.columns, grid.spacing}, &all});
  }
  std::vector<SandContact> contacts;
  for (std::size_t k = 0; k < bodies.size(); ++k)
    contacts.push_back(BodyInSand(all, all.bodies[k], bodies[k].window).contact());
  return contacts;
}

}  // namespace shallow_sand
