#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>

#include "random_fields.h"
#include "random_seed.h"
#include "shallow_sand/surface/blocks.h"
#include "shallow_sand/surface/surface_mesh.h"
#include "surface/mesh_figures.h"

namespace shallow_sand {
namespace {

std::vector<SurfaceMesh::Triangle> groundOf(const SurfaceMesh& mesh) {
  std::vector<SurfaceMesh::Triangle> ground = mesh.sand;
  ground.insert(ground.end(), mesh.bed.begin(), mesh.bed.end());
  return ground;
}

/// A number for each vertex, the same for those whose positions have the same bits.
std::vector<std::size_t> placesOf(const SurfaceMesh& mesh) {
  std::map<std::array<double, 3>, std::size_t> places;
  std::vector<std::size_t> numbers;
  for (const Eigen::Vector3d& p : mesh.positions)
    numbers.push_back(
        places.emplace(std::array<double, 3>{p.x(), p.y(), p.z()}, places.size()).first->second);
  return numbers;
}

/// Inner edges belong to two triangles that run along them in opposite directions; the others are the rim of
/// the lattice, once around.
void expectClosed(const SurfaceMesh& mesh, const Lattice& lattice) {
  const std::vector<std::size_t> places = placesOf(mesh);
  std::map<std::pair<std::size_t, std::size_t>, std::array<std::uint32_t, 2>> edges;
  for (const auto& triangle : groundOf(mesh)) {
    for (int corner = 0; corner < 3; ++corner) {
      const std::uint32_t from = triangle[corner];
      const std::uint32_t to = triangle[(corner + 1) % 3];
      EXPECT_TRUE(edges.insert({{places[from], places[to]}, {from, to}}).second) << "twice the same edge";
    }
  }
  double around = 0.0;
  for (const auto& edge : edges) {
    if (edges.count({edge.first.second, edge.first.first}) > 0) continue;
    const Eigen::Vector3d& from = mesh.positions[edge.second[0]];
    const Eigen::Vector3d& to = mesh.positions[edge.second[1]];
    const auto along = [&](int axis, double rim) { return from[axis] == rim && to[axis] == rim; };
    EXPECT_TRUE(along(0, lattice.x.front()) || along(0, lattice.x.back()) || along(1, lattice.y.front()) ||
                along(1, lattice.y.back()))
        << "a gap from " << from.transpose() << " to " << to.transpose();
    around += (to - from).head<2>().norm();
  }
  const double rim = 2.0 * (lattice.x.back() - lattice.x.front() + lattice.y.back() - lattice.y.front());
  EXPECT_NEAR(around, rim, 1e-9 * rim);
}

void expectFacesUp(const SurfaceMesh& mesh, const Lattice& lattice) {
  const double whole = lattice.width.front() * lattice.height.front();
  for (const auto* triangles : {&mesh.sand, &mesh.bed, &mesh.loads}) {
    for (const auto& triangle : *triangles) EXPECT_GT(areaVector(mesh, triangle).z(), 1e-8 * whole);
  }
  const double footprint = footprintOf(mesh, mesh.sand) + footprintOf(mesh, mesh.bed);
  const double size = (lattice.x.back() - lattice.x.front()) * (lattice.y.back() - lattice.y.front());
  EXPECT_NEAR(footprint, size, 1e-9 * size);
}

void expectMaterialsApart(const SurfaceMesh& mesh) {
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
  ASSERT_EQ(mesh.materials.size(), mesh.positions.size());
  const auto all = [&](const std::vector<SurfaceMesh::Triangle>& triangles, SurfaceMaterial material) {
    return std::all_of(triangles.begin(), triangles.end(), [&](const SurfaceMesh::Triangle& triangle) {
      return std::all_of(triangle.begin(), triangle.end(),
                         [&](std::uint32_t corner) { return mesh.materials[corner] == material; });
    });
  };
  EXPECT_TRUE(all(mesh.sand, SurfaceMaterial::sand));
  EXPECT_TRUE(all(mesh.bed, SurfaceMaterial::bed));
  for (const Eigen::Vector3f& normal : mesh.normals) {
    EXPECT_NEAR(normal.norm(), 1.0f, 1e-5f);
    EXPECT_GT(normal.z(), 0.0f);
  }
}

void expectLaws(const SurfaceMesh& mesh, const Lattice& lattice) {
  expectClosed(mesh, lattice);
  expectFacesUp(mesh, lattice);
  expectMaterialsApart(mesh);
}

/// The shore's vertices, those of the sand.
std::vector<std::uint32_t> shoreOf(const SurfaceMesh& mesh, const Grid& grid) {
  std::vector<std::uint32_t> shore;
  for (auto vertex = static_cast<std::uint32_t>(grid.cells()); vertex < mesh.positions.size(); vertex += 2) {
    EXPECT_EQ(mesh.materials[vertex], SurfaceMaterial::sand);
    EXPECT_EQ(mesh.materials[vertex + 1], SurfaceMaterial::bed);
    EXPECT_EQ(mesh.positions[vertex], mesh.positions[vertex + 1]);
    shore.push_back(vertex);
  }
  return shore;
}

Elevation randomPlane(std::mt19937& random, double steepest) {
  const double slope_x = uniform(random, -steepest, steepest);
  const double slope_y = uniform(random, -steepest, steepest);
  const double height = uniform(random, -0.1, 0.1);
  return [=](double x, double y) { return height + slope_x * x + slope_y * y; };
}

TEST(SurfaceMesh, RandomGroundIsOneSheetWithoutFolds) {
  std::mt19937 random = seededGenerator();
  const int columns = randomCount(random, 2, 60);
  const RandomSand sand = randomSand(random, columns, randomCount(random, 2, 60));
  Fields fields;
  fields.bed = sand.bed;
  fields.depth = sand.depth;
  // Depths near the threshold, too.
  const Grid grid = sand.parameters.grid.grid();
  for (float& depth : fields.depth) {
    if (random() % 8 == 0) depth = bareDepth(grid) * static_cast<float>(uniform(random, 0.0, 1.2));
    if (random() % 64 == 0) depth = bareDepth(grid);
  }
  if (random() % 2 == 0) {
    fields.addLoads();
    fields.load = randomWaves(random, grid);
    for (float& load : fields.load) load = std::max(0.0f, load);
    fields.load_elevation = sand.bed;
  }
  for (int level = 0; level < 4; ++level) {
    const Lattice lattice = blocksOf(grid, level);
    if (lattice.columns() < 2 || lattice.rows() < 2) continue;
    expectLaws(surfaceMesh(grid, fields, level), lattice);
  }
}

std::pair<Grid, Fields> randomGround(std::mt19937& random) {
  const RandomSand sand = randomSand(random, 20, 15);
  Fields fields;
  fields.bed = sand.bed;
  fields.depth = sand.depth;
  return {sand.parameters.grid.grid(), fields};
}

TEST(SurfaceMesh, PassesThroughTheMiddleOfEachCell) {
  std::mt19937 random = seededGenerator();
  const auto [grid, fields] = randomGround(random);
  const SurfaceMesh mesh = surfaceMesh(grid, fields);
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      const std::size_t k = grid.index(i, j);
      const double surface = static_cast<double>(fields.bed[k]) + static_cast<double>(fields.depth[k]);
      EXPECT_EQ(mesh.positions[k], Eigen::Vector3d(grid.x(i), grid.y(j), surface));
      EXPECT_EQ(mesh.materials[k] == SurfaceMaterial::sand, fields.depth[k] >= bareDepth(grid));
    }
  }
}

TEST(SurfaceMesh, HasNoTrianglesWithoutTwoRowsAndColumns) {
  for (const Size size : {Size{1, 1}, Size{1, 7}, Size{7, 1}}) {
    const Grid grid{size.columns, size.rows, 0.1f, 0.0, 0.0};
    Fields fields;
    fields.bed.assign(grid.cells(), 0.0f);
    fields.depth.assign(grid.cells(), 0.3f);
    EXPECT_EQ(surfaceMesh(grid, fields).triangles(), 0u);
  }
}

TEST(SurfaceMesh, ShoreOfAPlaneOnAPlaneIsExact) {
  std::mt19937 random = seededGenerator();
  const Grid grid = squareMetre(40);
  const double spacing = static_cast<double>(grid.spacing);
  const Shapes shapes{randomPlane(random, 1.0), randomPlane(random, 1.0)};
  const SurfaceMesh mesh = surfaceMesh(grid, shapes.fields(grid));
  expectLaws(mesh, blocksOf(grid, 0));
  std::size_t exact = 0;
  for (const std::uint32_t vertex : shoreOf(mesh, grid)) {
    const Eigen::Vector3d& place = mesh.positions[vertex];
    // Where sand ends beside the rim there may be none to tell its slope; a shore keeps off middles of cells.
    if (place.head<2>().cwiseAbs().maxCoeff() > 0.5 - 1.51 * spacing) continue;
    const Eigen::Array2d cell = (place.head<2>().array() + 0.5) / spacing - 0.5;
    if ((cell - cell.round()).abs().maxCoeff() < 2e-3) continue;
    const double slope =
        std::hypot(shapes.depth(1, 0) - shapes.depth(0, 0), shapes.depth(0, 1) - shapes.depth(0, 0));
    EXPECT_NEAR(shapes.depth(place.x(), place.y()), 0.1 * spacing, 1e-6 * (1.0 + slope));
    EXPECT_NEAR(place.z(), shapes.surface(place.x(), place.y()), 1e-6);
    ++exact;
  }
  std::cout << exact << " vertices" << std::endl;
}

struct ShoreErrors {
  double root_mean_square;  ///< [m]
  double largest;           ///< [m]
};

/// Distances of a shore's vertices from where sand is a tenth of a cell deep.
ShoreErrors shoreErrors(const Shapes& shapes, const Grid& grid) {
  const SurfaceMesh mesh = surfaceMesh(grid, shapes.fields(grid));
  const std::vector<std::uint32_t> shore = shoreOf(mesh, grid);
  EXPECT_GT(shore.size(), static_cast<std::size_t>(grid.columns));
  const auto deep = [&](double x, double y) { return shapes.depth(x, y); };
  double squares = 0.0, largest = 0.0;
  for (const std::uint32_t vertex : shore) {
    const Eigen::Vector3d& place = mesh.positions[vertex];
    const Eigen::Vector3d normal = exactNormal(deep, place);
    const double slope = normal.head<2>().norm() / normal.z();
    const double error =
        std::abs(deep(place.x(), place.y()) - 0.1 * static_cast<double>(grid.spacing)) / slope;
    squares += error * error;
    largest = std::max(largest, error);
  }
  return {std::sqrt(squares / static_cast<double>(shore.size())), largest};
}

/// A cap of a sphere, or a bowl of sand, that a tilted bed cuts, within the map.
Shapes cutCap(std::mt19937& random) {
  const double radius = uniform(random, 0.7, 0.9);
  const double x0 = uniform(random, -0.03, 0.03);
  const double y0 = uniform(random, -0.03, 0.03);
  const double sense = random() % 2 == 0 ? 1.0 : -1.0;
  const double slope_x = uniform(random, -0.1, 0.1);
  const double slope_y = uniform(random, -0.1, 0.1);
  const double flat = std::sqrt(radius * radius - 0.3 * 0.3);
  return {[=](double x, double y) { return slope_x * (x - x0) + slope_y * (y - y0); },
          [=](double x, double y) {
            const double square = radius * radius - std::pow(x - x0, 2) - std::pow(y - y0, 2);
            return sense * (std::sqrt(std::max(square, 0.0)) - flat);
          }};
}

TEST(SurfaceMesh, ShoresConvergeWithSecondOrder) {
  std::mt19937 random = seededGenerator();
  std::vector<Shapes> caps;
  while (caps.size() < 8) caps.push_back(cutCap(random));
  std::vector<double> typical, largest;
  for (const int side : {32, 64, 128, 256}) {
    typical.push_back(0.0);
    largest.push_back(0.0);
    for (const Shapes& shapes : caps) {
      const ShoreErrors errors = shoreErrors(shapes, squareMetre(side));
      typical.back() += errors.root_mean_square / static_cast<double>(caps.size());
      largest.back() = std::max(largest.back(), errors.largest);
    }
    EXPECT_LT(largest.back(), 0.25 / side);
  }
  expectOrder(typical, 1.8, "shore");
  expectOrder(largest, 1.7, "shore, largest");
}

/// A round heap on a level bed: its shape when it stands at a place, and what it measures.
struct Heap {
  std::function<Shapes(double x0, double y0)> shapes;
  std::function<double(double depth)> area;  ///< of its surface where it is deeper than that [m²]
  double volume;                             ///< [m³]
};

/// Mean errors over heaps that stand anywhere.
void expectToConverge(std::mt19937& random, const Heap& heap, double order) {
  std::vector<double> areas, volumes;
  for (const int side : {32, 64, 128, 256}) {
    const Grid grid = squareMetre(side);
    constexpr int kHeaps = 16;
    double area = 0.0, volume = 0.0;
    for (int repeat = 0; repeat < kHeaps; ++repeat) {
      const double x0 = uniform(random, -0.05, 0.05);
      const Shapes shapes = heap.shapes(x0, uniform(random, -0.05, 0.05));
      const SurfaceMesh mesh = surfaceMesh(grid, shapes.fields(grid));
      const double above = heap.area(static_cast<double>(bareDepth(grid)));
      area += std::abs(areaOf(mesh, mesh.sand) / above - 1.0) / kHeaps;
      volume += std::abs(volumeUnder(mesh, groundOf(mesh)) / heap.volume - 1.0) / kHeaps;
    }
    areas.push_back(area);
    volumes.push_back(volume);
  }
  EXPECT_LT(areas.back(), 2e-4);
  EXPECT_LT(volumes.back(), 2e-4);
  expectOrder(areas, order, "area");
  expectOrder(volumes, order, "volume");
}

double levelBed(double, double) { return 0.0; }

TEST(SurfaceMesh, AreaAndVolumeOfAConeConverge) {
  std::mt19937 random = seededGenerator();
  constexpr double kRadius = 0.35;
  constexpr double kSlope = 0.6;
  const auto cone = [](double x0, double y0) -> Shapes {
    return {levelBed, [=](double x, double y) { return kSlope * (kRadius - std::hypot(x - x0, y - y0)); }};
  };
  const auto area = [](double depth) {
    return M_PI * std::pow(kRadius - depth / kSlope, 2) * std::hypot(1.0, kSlope);
  };
  // Around the tip curvature grows without bound: ΔL² log(1/ΔL).
  expectToConverge(random, {cone, area, M_PI * std::pow(kRadius, 3) * kSlope / 3.0}, 1.6);
}

TEST(SurfaceMesh, AreaAndVolumeOfACapConvergeWithSecondOrder) {
  std::mt19937 random = seededGenerator();
  constexpr double kRadius = 0.6;  // of the sphere
  constexpr double kHeight = 0.15;
  const auto cap = [](double x0, double y0) -> Shapes {
    return {levelBed, [=](double x, double y) {
              const double square = kRadius * kRadius - std::pow(x - x0, 2) - std::pow(y - y0, 2);
              return std::sqrt(std::max(square, 0.0)) - kRadius + kHeight;
            }};
  };
  const auto area = [](double depth) { return 2.0 * M_PI * kRadius * (kHeight - depth); };
  expectToConverge(random, {cap, area, M_PI * kHeight * kHeight * (kRadius - kHeight / 3.0)}, 1.8);
}

TEST(SurfaceMesh, APlaneOfSandIsExactAtEveryLevel) {
  std::mt19937 random = seededGenerator();
  const Grid grid{randomCount(random, 17, 50), randomCount(random, 17, 50), 0.05f, 3.0, -7.0};
  const Elevation plane = randomPlane(random, 1.0);
  const Shapes shapes{[&](double x, double y) { return plane(x, y) - 0.5; }, plane};
  const double slope = std::hypot(plane(1, 0) - plane(0, 0), plane(0, 1) - plane(0, 0));
  for (int level = 0; level < 4; ++level) {
    const SurfaceMesh mesh = surfaceMesh(grid, shapes.fields(grid), level);
    const Lattice lattice = blocksOf(grid, level);
    expectLaws(mesh, lattice);
    const double footprint = footprintOf(mesh, mesh.sand);
    EXPECT_NEAR(areaOf(mesh, mesh.sand), footprint * std::hypot(1.0, slope), 1e-4 * footprint);
    for (std::size_t vertex = 0; vertex < mesh.positions.size(); ++vertex) {
      const Eigen::Vector3d& place = mesh.positions[vertex];
      EXPECT_NEAR(place.z(), plane(place.x(), place.y()), 1e-5);
      EXPECT_LT((mesh.normals[vertex].cast<double>() - exactNormal(plane, place)).norm(), 1e-4);
    }
  }
}

Elevation wavesOf(std::mt19937& random) {
  const double kx = uniform(random, 3.0, 6.0);
  const double ky = uniform(random, 3.0, 6.0);
  const double phase = uniform(random, 0.0, 6.0);
  return [=](double x, double y) { return 0.08 * std::sin(kx * x + phase) * std::cos(ky * y - phase); };
}

TEST(SurfaceMesh, NormalsConvergeWithSecondOrder) {
  std::mt19937 random = seededGenerator();
  const Elevation waves = wavesOf(random);
  const Shapes sand{[&](double x, double y) { return waves(x, y) - 0.5; }, waves};
  const Shapes bed{waves, [](double, double) { return -9.0; }};
  for (const Shapes* shapes : {&sand, &bed}) {
    std::vector<double> inside, at_rim;
    for (const int side : {32, 64, 128}) {
      const Grid grid = squareMetre(side);
      const SurfaceMesh mesh = surfaceMesh(grid, shapes->fields(grid));
      double worst_inside = 0.0, worst_at_rim = 0.0;
      for (int j = 0; j < side; ++j) {
        for (int i = 0; i < side; ++i) {
          const std::size_t k = grid.index(i, j);
          const bool rim = i == 0 || j == 0 || i == side - 1 || j == side - 1;
          double& worst = rim ? worst_at_rim : worst_inside;
          worst = std::max(worst,
                           (mesh.normals[k].cast<double>() - exactNormal(waves, mesh.positions[k])).norm());
        }
      }
      inside.push_back(worst_inside);
      at_rim.push_back(worst_at_rim);
    }
    expectOrder(inside, 1.8, "normals");
    expectOrder(at_rim, 0.9, "normals at the rim");
  }
}

TEST(SurfaceMesh, NormalsAtTheShoreAreThoseOfEachMaterial) {
  std::mt19937 random = seededGenerator();
  const Elevation waves = wavesOf(random);
  const Shapes shapes{waves, [](double x, double y) { return 0.3 * x - 0.2 * y + 0.2 * (x * x + y * y); }};
  std::vector<double> bed;
  for (const int side : {64, 128, 256, 512}) {
    const Grid grid = squareMetre(side);
    const SurfaceMesh mesh = surfaceMesh(grid, shapes.fields(grid));
    double worst_sand = 0.0, worst_bed = 0.0;
    for (const std::uint32_t vertex : shoreOf(mesh, grid)) {
      const Eigen::Vector3d& place = mesh.positions[vertex];
      if (place.head<2>().cwiseAbs().maxCoeff() > 0.5 - 2.01 / side) continue;
      const auto error = [&](std::uint32_t at, const Elevation& elevation) {
        return (mesh.normals[at].cast<double>() - exactNormal(elevation, place)).norm();
      };
      worst_sand = std::max(worst_sand, error(vertex, shapes.surface));
      worst_bed = std::max(worst_bed, error(vertex + 1, shapes.bed));
    }
    EXPECT_LT(worst_sand, 4.0 / side);
    bed.push_back(worst_bed);
  }
  expectOrder(bed, 1.8, "normals of the bed");
}

TEST(SurfaceMesh, ColoursTellMaterialsAndSlopes) {
  const auto slope = [](double x, double y) {
    return surfaceColour(SurfaceMaterial::sand,
                         Eigen::Vector3f(static_cast<float>(-x), static_cast<float>(-y), 1.0f).normalized());
  };
  const Eigen::Vector3f level = slope(0.0, 0.0);
  EXPECT_GT(level.x(), level.z() + 0.2f);
  EXPECT_GT(slope(0.4, -0.4).z(), 1.1f * level.z());  // towards the north-west
  EXPECT_LT(slope(-0.4, 0.4).z(), 0.8f * level.z());
  const Eigen::Vector3f bed = surfaceColour(SurfaceMaterial::bed, Eigen::Vector3f::UnitZ());
  EXPECT_LT(bed.maxCoeff() - bed.minCoeff(), 0.05f);
  std::mt19937 random = seededGenerator();
  const auto [grid, fields] = randomGround(random);
  const SurfaceMesh mesh = surfaceMesh(grid, fields);
  const std::vector<Eigen::Vector3f> visible = visibleColours(grid, fields);
  ASSERT_EQ(visible.size(), grid.cells());
  for (std::size_t k = 0; k < grid.cells(); ++k) EXPECT_EQ(visible[k], mesh.colour(k));
}

}  // namespace
}  // namespace shallow_sand
