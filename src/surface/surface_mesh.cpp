#include "shallow_sand/surface/surface_mesh.h"

#include <algorithm>
#include <utility>

#include "relief.h"
#include "shallow_sand/surface/blocks.h"

namespace shallow_sand {

namespace {

constexpr std::uint32_t kNone = 0xffffffffu;

/// How near to a cell's middle a shore may come, of the distance between two: no triangle is flat.
constexpr double kNearest = 1e-3;

struct Cell {
  std::size_t i;
  std::size_t j;
  std::uint32_t vertex;
};

class MeshBuilder {
 public:
  explicit MeshBuilder(const Relief& relief)
      : relief_(relief), lattice_(relief.lattice()), shore_(6 * lattice_.columns(), kNone) {}

  SurfaceMesh build() {
    addCells();
    addGround();
    if (relief_.hasLoads()) addLoads();
    return std::move(mesh_);
  }

 private:
  Cell cell(std::size_t i, std::size_t j) const {
    return {i, j, static_cast<std::uint32_t>(lattice_.index(i, j))};
  }

  std::uint32_t addVertex(const Eigen::Vector3d& position, const Eigen::Vector3f& normal,
                          SurfaceMaterial material) {
    mesh_.positions.push_back(position);
    mesh_.normals.push_back(normal);
    mesh_.materials.push_back(material);
    return static_cast<std::uint32_t>(mesh_.positions.size() - 1);
  }

  void addCells() {
    const std::size_t cells = lattice_.cells();
    mesh_.positions.reserve(cells);
    mesh_.normals.reserve(cells);
    mesh_.materials.reserve(cells);
    for (std::size_t j = 0; j < lattice_.rows(); ++j) {
      for (std::size_t i = 0; i < lattice_.columns(); ++i) {
        const std::size_t k = lattice_.index(i, j);
        addVertex({lattice_.x[i], lattice_.y[j], relief_.ground(k)}, relief_.groundNormal(i, j),
                  relief_.material(k));
      }
    }
    const auto sand = static_cast<std::size_t>(
        std::count(mesh_.materials.begin(), mesh_.materials.end(), SurfaceMaterial::sand));
    mesh_.sand.reserve(2 * sand);
    mesh_.bed.reserve(2 * (cells - sand));
  }

  /// Calls `add` with the corners of both triangles of each square.
  template <class Add>
  void forEachTriangle(std::size_t j, const Add& add) const {
    for (std::size_t i = 0; i + 1 < lattice_.columns(); ++i) {
      add(cell(i, j), cell(i + 1, j), cell(i + 1, j + 1));
      add(cell(i, j), cell(i + 1, j + 1), cell(i, j + 1));
    }
  }

  void addGround() {
    for (std::size_t j = 0; j + 1 < lattice_.rows(); ++j) {
      std::fill_n(shoreBegin(j + 1), 3 * lattice_.columns(), kNone);
      forEachTriangle(j, [&](const Cell& a, const Cell& b, const Cell& c) { addTriangle(a, b, c); });
    }
  }

  SurfaceMaterial material(const Cell& c) const { return mesh_.materials[c.vertex]; }

  std::vector<SurfaceMesh::Triangle>& trianglesOf(SurfaceMaterial material) {
    return material == SurfaceMaterial::sand ? mesh_.sand : mesh_.bed;
  }

  void addTriangle(const Cell& a, const Cell& b, const Cell& c) {
    const bool as_b = material(a) == material(b);
    const bool as_c = material(a) == material(c);
    if (as_b && as_c) {
      trianglesOf(material(a)).push_back({a.vertex, b.vertex, c.vertex});
    } else if (as_b) {
      cutOff(c, a, b);
    } else if (as_c) {
      cutOff(b, c, a);
    } else {
      cutOff(a, b, c);
    }
  }

  /// A triangle whose corner `a` is of another material than `b` and `c`.
  void cutOff(const Cell& a, const Cell& b, const Cell& c) {
    const std::uint32_t to_b = shoreBetween(a, b);
    const std::uint32_t to_c = shoreBetween(a, c);
    const std::uint32_t own = material(a) == SurfaceMaterial::sand ? 0 : 1;
    const std::uint32_t other = 1 - own;
    trianglesOf(material(a)).push_back({a.vertex, to_b + own, to_c + own});
    std::vector<SurfaceMesh::Triangle>& rest = trianglesOf(material(b));
    rest.push_back({to_b + other, b.vertex, c.vertex});
    rest.push_back({to_b + other, c.vertex, to_c + other});
  }

  /// For each cell of a row, the shore's vertices on its edges to the east, the north and the north-east. Two
  /// rows are kept.
  std::vector<std::uint32_t>::iterator shoreBegin(std::size_t j) {
    return shore_.begin() + static_cast<std::ptrdiff_t>((j % 2) * 3 * lattice_.columns());
  }

  /// The sand's vertex of the shore between two cells, one of sand and one of bare bed; the bed's is the
  /// next.
  std::uint32_t shoreBetween(const Cell& a, const Cell& b) {
    const Cell& first = a.vertex < b.vertex ? a : b;
    const Cell& last = a.vertex < b.vertex ? b : a;
    const std::size_t edge = first.j == last.j ? 0 : first.i == last.i ? 1 : 2;
    std::uint32_t& vertex = *(shoreBegin(first.j) + static_cast<std::ptrdiff_t>(3 * first.i + edge));
    if (vertex == kNone) vertex = material(a) == SurfaceMaterial::sand ? addShore(a, b) : addShore(b, a);
    return vertex;
  }

  std::uint32_t addShore(const Cell& sand, const Cell& bare) {
    const double t = sandEnd(sand, bare);
    const auto between = [t](double at_sand, double at_bare) { return at_sand + t * (at_bare - at_sand); };
    const Eigen::Vector3d position(
        between(lattice_.x[sand.i], lattice_.x[bare.i]), between(lattice_.y[sand.j], lattice_.y[bare.j]),
        between(relief_.bed(sand.vertex), relief_.bed(bare.vertex)) + relief_.bareDepth());
    const Eigen::Vector2d below = relief_.bedGradient(sand.i, sand.j);
    const Eigen::Vector2d beside = relief_.bedGradient(bare.i, bare.j);
    const std::uint32_t vertex = addVertex(position, mesh_.normals[sand.vertex], SurfaceMaterial::sand);
    addVertex(position, normalOf(below + t * (beside - below)), SurfaceMaterial::bed);
    return vertex;
  }

  /// Where the sand ends, from 0 at the sand's cell to 1 at the bare one. What the bare cell lacks to hold
  /// the surface's extension counts as negative depth: depths, which end at 0, alone would put the shore too
  /// far out, by an amount of first order that leaps from cell to cell.
  double sandEnd(const Cell& sand, const Cell& bare) const {
    const Eigen::Vector2d step(lattice_.x[bare.i] - lattice_.x[sand.i],
                               lattice_.y[bare.j] - lattice_.y[sand.j]);
    const double extension = relief_.ground(sand.vertex) + relief_.sandGradient(sand.i, sand.j).dot(step);
    const double depth = relief_.depth(sand.vertex);
    const double depth_beyond = std::min(relief_.depth(bare.vertex), extension - relief_.bed(bare.vertex));
    return std::clamp((depth - relief_.bareDepth()) / (depth - depth_beyond), kNearest, 1.0 - kNearest);
  }

  void addLoads() {
    std::vector<std::uint32_t> vertices(lattice_.cells(), kNone);
    const auto vertexOf = [&](const Cell& c) {
      if (vertices[c.vertex] == kNone) {
        vertices[c.vertex] = addVertex({lattice_.x[c.i], lattice_.y[c.j], relief_.visible(c.vertex)},
                                       normalOf(relief_.visibleGradient(c.i, c.j)),
                                       relief_.hasLoad(c.vertex) ? SurfaceMaterial::sand : material(c));
      }
      return vertices[c.vertex];
    };
    for (std::size_t j = 0; j + 1 < lattice_.rows(); ++j) {
      forEachTriangle(j, [&](const Cell& a, const Cell& b, const Cell& c) {
        if (!relief_.hasLoad(a.vertex) && !relief_.hasLoad(b.vertex) && !relief_.hasLoad(c.vertex)) return;
        const auto [low, high] =
            std::minmax({relief_.visible(a.vertex), relief_.visible(b.vertex), relief_.visible(c.vertex)});
        if (relief_.isStep(low, high)) return;
        const std::uint32_t first = vertexOf(a);
        const std::uint32_t second = vertexOf(b);
        mesh_.loads.push_back({first, second, vertexOf(c)});
      });
    }
  }

  const Relief& relief_;
  const Lattice& lattice_;
  SurfaceMesh mesh_;
  std::vector<std::uint32_t> shore_;
};

}  // namespace

SurfaceMesh surfaceMesh(const Grid& grid, const Fields& fields, int level) {
  const Lattice lattice = blocksOf(grid, level);
  if (level == 0) return MeshBuilder(Relief(lattice, fields, bareDepth(grid))).build();
  const Fields means = blockMeans(grid, fields, level);
  return MeshBuilder(Relief(lattice, means, bareDepth(grid))).build();
}

}  // namespace shallow_sand
