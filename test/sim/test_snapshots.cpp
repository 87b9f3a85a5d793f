#include <gtest/gtest.h>

#include <functional>
#include <numeric>

#include "random_scene.h"
#include "random_seed.h"
#include "same_run.h"
#include "shallow_sand/scene/geotiff.h"

namespace shallow_sand {
namespace {

RandomScene busyScene(std::mt19937& random) {
  RandomSand sand =
      randomSand(random, 1 + static_cast<int>(random() % 90), 1 + static_cast<int>(random() % 50));
  sand.parameters.gravity = randomGravity(random, 2.0);
  sand.parameters.threads = 1 + static_cast<int>(random() % 2);
  return randomScene(random, std::move(sand), static_cast<int>(random() % 3), static_cast<int>(random() % 3));
}

Simulator simulatorOf(const RandomScene& scene) { return simulatorOf(scene, scene.sand.parameters); }

TEST(Snapshots, ARunGoesOnBitForBit) {
  std::mt19937 random = seededGenerator();
  for (int number = 0; number < 40; ++number) {
    const RandomScene scene = busyScene(random);
    Simulator whole = simulatorOf(scene);
    advanceFrames(whole, scene.frame, 0, 20);
    const int half = static_cast<int>(random() % 20);
    Simulator first = simulatorOf(scene);
    advanceFrames(first, scene.frame, 0, half);
    Simulator second = simulatorOf(scene);
    second.restore(first.snapshot());
    advanceFrames(second, scene.frame, half, 20);
    SCOPED_TRACE("scene " + std::to_string(number) + ", taken after frame " + std::to_string(half));
    expectSameButForRoundings(whole, second);
    if (HasFailure()) return;
  }
}

TEST(Snapshots, ASavedRunGoesOnBitForBit) {
  std::mt19937 random = seededGenerator();
  for (int number = 0; number < 10; ++number) {
    const RandomScene scene = busyScene(random);
    Simulator whole = simulatorOf(scene);
    advanceFrames(whole, scene.frame, 0, 16);
    {
      Simulator first = simulatorOf(scene);
      advanceFrames(first, scene.frame, 0, 8);
      saveState("half.tif", first.parameters(), first.snapshot());
    }
    Simulator second = simulatorOf(scene);
    second.restore(loadState("half.tif", scene.sand.parameters));
    advanceFrames(second, scene.frame, 8, 16);
    SCOPED_TRACE("scene " + std::to_string(number));
    expectSameButForRoundings(whole, second);
    if (HasFailure()) return;
  }
}

TEST(Snapshots, ThatDoNotFitAreRefusedAndChangeNothing) {
  std::mt19937 random = seededGenerator();
  const RandomSand sand = randomSand(random, 20, 10);
  Simulator simulator(sand.parameters, sand.bed, sand.depth);
  const auto refused = [&](const std::function<void(Snapshot&)>& spoil) {
    Snapshot snapshot = simulator.snapshot();
    spoil(snapshot);
    EXPECT_THROW(simulator.restore(snapshot), InvalidParameter);
    EXPECT_TRUE(sameBits(simulator.fields().depth, sand.depth));
  };
  refused([](Snapshot& s) { s.fields.depth.pop_back(); });
  refused([](Snapshot& s) { s.fields.depth[3] = -1.0f; });
  refused([](Snapshot& s) { s.fields.momentum_y[5] = std::nanf(""); });
  refused([](Snapshot& s) { s.time = std::nan(""); });
  refused([](Snapshot& s) { s.next_step = 0.0; });
  refused([](Snapshot& s) { s.contacts.windows = {{0, 0, 2, 2}}; });
  refused([](Snapshot& s) { s.ledger.poured = std::nan(""); });
  refused([](Snapshot& s) { s.ledger.start = -1.0; });
}

double sumOf(const std::vector<float>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

TEST(Snapshots, GoOnWithoutTheirBodies) {
  std::mt19937 random = seededGenerator();
  double held = 0.0;
  for (int number = 0; number < 30; ++number) {
    RandomScene scene = busyScene(random);
    Snapshot snapshot;
    {
      Simulator with_bodies = simulatorOf(scene);
      advanceFrames(with_bodies, scene.frame, 0, 10);
      snapshot = with_bodies.snapshot();
    }
    scene.bodies.clear();
    Simulator alone = simulatorOf(scene);
    alone.restore(withoutBodies(snapshot));
    const Fields fields = alone.fields();
    for (std::size_t k = 0; k < fields.depth.size(); ++k)
      ASSERT_EQ(fields.depth[k], snapshot.fields.allDepth(k));
    held += sumOf(snapshot.fields.load);
    const double momentum = sumOf(snapshot.fields.momentum_x) + sumOf(snapshot.fields.load_momentum_x);
    EXPECT_NEAR(sumOf(fields.momentum_x), momentum, 1e-5 * (1.0 + std::abs(momentum)));
    advanceFrames(alone, scene.frame, 10, 16);
    EXPECT_LT(alone.ledger().error(), 1e-6);
  }
  EXPECT_GT(held, 0.0) << "no body held any sand";
}

}  // namespace
}  // namespace shallow_sand
