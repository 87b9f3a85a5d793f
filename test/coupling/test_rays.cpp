#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "random_bodies.h"
#include "random_seed.h"
#include "shallow_sand/coupling/rays_alone.h"
#include "shallow_sand/coupling/rays_together.h"
#include "shallow_sand/sim/body_windows.h"

namespace shallow_sand {
namespace {

constexpr int kScenes = 200;
constexpr int kBodies = 12;

Vector3 toVector3(const Eigen::Vector3d& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

/// What rays need to know of a body.
BodyView viewOf(const DistanceField& field, const Eigen::Isometry3d& pose) {
  BodyView view{};
  view.field = field.view(field.distance.data());
  const Eigen::Matrix3d to_body = pose.linear().transpose();
  view.axis_x = toVector3(to_body.col(0));
  view.axis_y = toVector3(to_body.col(1));
  view.axis_z = toVector3(to_body.col(2));
  view.position = toVector3(pose.translation());
  Eigen::AlignedBox3d box;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d steps(corner & 1 ? field.samples[0] - 1 : 0, corner & 2 ? field.samples[1] - 1 : 0,
                                corner & 4 ? field.samples[2] - 1 : 0);
    box.extend(pose * (field.origin + field.spacing * steps));
  }
  view.low = toVector3(box.min());
  view.high = toVector3(box.max());
  return view;
}

/// Turned anyhow, by right angles, or about the vertical: rays then run along faces of the field's box.
Eigen::Quaterniond randomTurn(std::mt19937& random) {
  const double angle = random() % 2 == 0 ? uniform(random, -M_PI, M_PI) : M_PI_2 * (random() % 4);
  switch (random() % 3) {
    case 0:
      return randomRotation(random);
    case 1:
      return Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()));
    default:
      return Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitX()));
  }
}

/// Some of the bodies on an uneven bed, in windows that hold them, as an engine on the host has them.
class RandomBodies {
 public:
  RandomBodies(std::mt19937& random, const Size& size, float spacing, const std::vector<RandomBody>& bodies)
      : grid_{size.columns, size.rows, spacing, 0.0, 0.0}, bed_(grid_.cells()) {
    const std::vector<float> waves = randomWaves(random, grid_);
    std::transform(waves.begin(), waves.end(), bed_.data(),
                   [&](float h) { return 4.0f * grid_.spacing * h; });
    std::vector<PlacedBody> placed;
    std::vector<Window> windows;
    const int count = randomCount(random, 1, kBodies);
    for (int k = 0; k < count; ++k) {
      placed.push_back(place(random, bodies[static_cast<std::size_t>(k)]));
      views_.push_back(placed.back().view);
      windows.push_back(placed.back().window.grown(randomCount(random, 0, 20), grid_));
    }
    windows_ = withoutOverlap(windows);
    lists_ = binLists(placed, windows_);
  }

  std::size_t cells() const { return grid_.cells(); }

  /// Calls function(bodies) for each window.
  template <class Function>
  void forEachWindow(const Function& function) const {
    for (std::size_t k = 0; k < windows_.size(); ++k) {
      const BodyBins bins{views_.data(), lists_.first.data() + lists_.first_begins[k], lists_.members.data(),
                          windows_[k], lists_.across[k]};
      function(BodiesOverBed{bins, bed_.data(), grid_.columns, grid_.spacing});
    }
  }

 private:
  /// Anywhere over the grid, and beyond its edge by up to the body's radius.
  PlacedBody place(std::mt19937& random, const RandomBody& body) const {
    const double spacing = static_cast<double>(grid_.spacing);
    const double x = uniform(random, -body.radius, grid_.columns * spacing + body.radius);
    const double y = uniform(random, -body.radius, grid_.rows * spacing + body.radius);
    const double z = uniform(random, -1.0, 1.0) * (body.radius + 4.0 * spacing);
    const BodyView view = viewOf(*body.field, poseOf({x, y}, z, randomTurn(random)));
    const auto wide = [](float position) { return static_cast<double>(position); };
    return {0, view,
            Window::around(wide(view.low.x), wide(view.low.y), wide(view.high.x), wide(view.high.y), grid_),
            false};
  }

  Grid grid_;
  HostExecutor::Memory<float> bed_;
  std::vector<BodyView> views_;
  std::vector<Window> windows_;
  BinLists lists_;
};

struct RecordSolids : BodiesOverBed {
  std::vector<SolidIntervals>* solids;
  void operator()(int i, int j, const SolidIntervals& found) const {
    (*solids)[static_cast<std::size_t>(cellAt(i, j))] = found;
  }
};

/// What the rays meet; a column that is not looked at has a negative number of intervals.
template <class Rays>
std::vector<SolidIntervals> solidsBy(const Rays& rays, const RandomBodies& bodies, int threads) {
  SolidIntervals none;
  none.count = -1;
  std::vector<SolidIntervals> solids(bodies.cells(), none);
  const HostExecutor executor(threads);
  bodies.forEachWindow([&](const BodiesOverBed& window) {
    rays.forEachColumn(executor, RecordSolids{window, &solids});
  });
  return solids;
}

bool same(const SolidIntervals& one, const SolidIntervals& other) {
  return one.count == other.count &&
         (one.count <= 0 || std::memcmp(one.at, other.at, sizeof(SolidInterval) * one.count) == 0);
}

/// Sizes that are no multiple of anything, down to a single cell.
Size randomSize(std::mt19937& random) {
  return random() % 4 == 0 ? Size{randomCount(random, 1, 5), randomCount(random, 1, 5)}
                           : Size{randomCount(random, 1, 80), randomCount(random, 1, 50)};
}

TEST(Rays, TogetherMeetTheSameAsAlone) {
  std::mt19937 random = seededGenerator();
  const double spacing = uniform(random, 0.005, 0.2);
  std::vector<RandomBody> kinds;
  for (int k = 0; k < kBodies; ++k) kinds.push_back(randomBody(random, spacing));
  int several = 0;
  int solid = 0;
  for (int scene = 0; scene < kScenes; ++scene) {
    const RandomBodies bodies(random, randomSize(random), static_cast<float>(spacing), kinds);
    const std::vector<SolidIntervals> alone = solidsBy(RaysAlone{}, bodies, 1);
    for (const SolidIntervals& solids : alone) {
      solid += solids.count > 0;
      several += solids.count > 1;
    }
    for (const InstructionSet set : instructionSets()) {
      const std::vector<SolidIntervals> together =
          solidsBy(RaysTogether(set), bodies, randomCount(random, 1, 3));
      for (std::size_t k = 0; k < alone.size(); ++k)
        ASSERT_TRUE(same(alone[k], together[k]))
            << "scene " << scene << ", cell " << k << ", " << toString(set);
    }
  }
  std::printf("%d columns with solids, %d with several\n", solid, several);
  EXPECT_GT(several, 0);
}

}  // namespace
}  // namespace shallow_sand
