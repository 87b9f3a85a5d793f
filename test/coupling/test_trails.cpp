#include <gtest/gtest.h>

#include <map>

#include "coupling/bodies_in_sand.h"

namespace shallow_sand {
namespace {

// The paper's figure 9: three shapes are dragged side by side and leave different trails.
constexpr double kSpacing = 0.02;
constexpr double kSurface = 0.3;
constexpr double kSunk = 0.1;
constexpr double kHalfWidth = 0.2;  ///< of each at the old surface, or less
constexpr double kStartX = 0.6;
constexpr double kTravel = 1.0;
constexpr double kSpeed = 0.2;
constexpr double kBallRadius = 0.25;  ///< its cap of depth kSunk is 0.4 m wide
constexpr double kRollerRadius = 0.15;

struct Dragged {
  const char* name;
  double y;
  Shape shape;
  double below;                           ///< from its origin down to its lowest point [m]
  double (*silhouette)(double sideways);  ///< its depth below the old surface, seen along its way [m]
};

double discSilhouette(double radius, double sideways) {
  const double inside = radius * radius - sideways * sideways;
  return inside > 0.0 ? std::max(0.0, kSunk - radius + std::sqrt(inside)) : 0.0;
}
double boxSilhouette(double sideways) { return std::abs(sideways) < kHalfWidth ? kSunk : 0.0; }
double ballSilhouette(double sideways) { return discSilhouette(kBallRadius, sideways); }
double rollerSilhouette(double sideways) { return discSilhouette(kRollerRadius, sideways); }

/// A cylinder that lies along its way.
TriangleMesh roller() {
  TriangleMesh mesh;
  mesh.append(triangulate(Cylinder{kRollerRadius, 0.4}),
              Eigen::Isometry3d(turned(0.5 * M_PI, Eigen::Vector3d::UnitY())));
  return mesh;
}

std::vector<Dragged> threeShapes() {
  return {{"box", 0.8, Box{{0.3, 2.0 * kHalfWidth, 0.6}}, 0.3, boxSilhouette},
          {"ball", 2.4, Sphere{kBallRadius}, kBallRadius, ballSilhouette},
          {"roller", 4.0, roller(), kRollerRadius, rollerSilhouette}};
}

Scene sceneOf(const std::vector<Dragged>& shapes) {
  Scene scene = levelSand({2.4, 4.8}, kSpacing, kSurface);
  scene.parameters.material.layer_depth = 10.0 * kSpacing;
  for (const Dragged& dragged : shapes) {
    const Eigen::Vector3d from(kStartX, dragged.y, kSurface - kSunk + dragged.below);
    SceneBody body;
    body.name = dragged.name;
    body.shape = dragged.shape;
    body.motion = straightMotion(from, from + Eigen::Vector3d(kTravel, 0.0, 0.0), kSpeed);
    scene.bodies.push_back(body);
  }
  return scene;
}

/// Depth below the old surface of the sand that is left under a body, and of the trail behind it; from
/// kHalfWidth on one side to kHalfWidth on the other.
struct Section {
  std::vector<double> under;
  std::vector<double> trail;
  std::vector<double> silhouette;
};

Section sectionOf(const Dragged& dragged, const Grid& grid, const Fields& fields) {
  Section section;
  const auto column = [&](double x) { return static_cast<int>((x - grid.origin_x) / grid.spacing); };
  const int middle = column(kStartX + kTravel);
  const int behind = column(kStartX + 0.5 * kTravel);
  for (int j = 0; j < grid.rows; ++j) {
    const double sideways = grid.y(j) - dragged.y;
    if (std::abs(sideways) > kHalfWidth) continue;
    const std::size_t k = grid.index(middle, j);
    section.under.push_back(kSurface - static_cast<double>(fields.bed[k] + fields.depth[k]));
    section.trail.push_back(kSurface - fields.surface(grid.index(behind, j)));
    section.silhouette.push_back(dragged.silhouette(sideways));
  }
  return section;
}

double areaBelow(const std::vector<double>& section) {
  double sum = 0.0;
  for (const double depth : section) sum += std::max(depth, 0.0);
  return sum * kSpacing;
}

double largestDifference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) largest = std::max(largest, std::abs(a[k] - b[k]));
  return largest;
}

/// Where the silhouette is this deep, the body's own side keeps sand away; higher up its berm lies on it.
double largestMisfit(const Section& section) {
  double largest = 0.0;
  for (std::size_t k = 0; k < section.under.size(); ++k) {
    if (section.silhouette[k] > 0.2 * kSunk)
      largest = std::max(largest, std::abs(section.under[k] - section.silhouette[k]));
  }
  return largest;
}

TEST(Trails, AreCutByEachShapeAsItsSilhouetteIsAndDiffer) {
  const std::vector<Dragged> shapes = threeShapes();
  Simulator simulator = buildSimulator(sceneOf(shapes));
  const double most_overlap = runWatchingOverlap(simulator, kTravel / kSpeed);
  const Grid& grid = simulator.grid();
  const Fields fields = simulator.fields();
  std::map<std::string, Section> sections;
  for (const Dragged& dragged : shapes) {
    const Section section = sectionOf(dragged, grid, fields);
    const double deepest = *std::max_element(section.trail.begin(), section.trail.end());
    std::printf(
        "%-6s silhouette %.5f m^2, under the body %.5f, trail %.5f; off the silhouette by %.4f m; "
        "trail %.4f m deep\n",
        dragged.name, areaBelow(section.silhouette), areaBelow(section.under), areaBelow(section.trail),
        largestMisfit(section), deepest);
    EXPECT_LT(largestMisfit(section), 0.02 * kSunk) << dragged.name;
    EXPECT_LT(deepest, 1.02 * kSunk) << dragged.name;
    // Sides steeper than friction holds slump into the trail, and berms beside it do; it stays a trail.
    EXPECT_LT(areaBelow(section.trail), 1.02 * areaBelow(section.silhouette)) << dragged.name;
    EXPECT_GT(areaBelow(section.trail), 0.3 * areaBelow(section.silhouette)) << dragged.name;
    sections[dragged.name] = section;
  }
  // Lengths of the box and the roller, and the ball's cap.
  const double submerged = 0.3 * areaBelow(sections["box"].silhouette) +
                           0.4 * areaBelow(sections["roller"].silhouette) +
                           M_PI * kSunk * kSunk * (kBallRadius - kSunk / 3.0);
  std::printf("overlap at most %.2f %% of what is submerged\n", 100.0 * most_overlap / submerged);
  EXPECT_GT(areaBelow(sections["box"].trail), areaBelow(sections["ball"].trail));
  EXPECT_GT(areaBelow(sections["ball"].trail), areaBelow(sections["roller"].trail));
  EXPECT_GT(largestDifference(sections["box"].trail, sections["ball"].trail), 0.1 * kSunk);
  EXPECT_GT(largestDifference(sections["ball"].trail, sections["roller"].trail), 0.1 * kSunk);
  EXPECT_LT(most_overlap, 0.05 * submerged);
  EXPECT_LT(simulator.ledger().error(), 1e-6);
}

}  // namespace
}  // namespace shallow_sand
