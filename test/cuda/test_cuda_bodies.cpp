#include <gtest/gtest.h>

#include <string>

#include "parity.h"

namespace shallow_sand {
namespace {

class CudaBodies : public CudaTest {
 protected:
  /// Random sand for `bodies` that move through it, unless a test lets them do something else.
  RandomScene sceneWith(int bodies, int pours = 0) { return tiltedScene(random_, {20, 12}, pours, bodies); }

  /// A pose in the sand or near it.
  Eigen::Isometry3d anyPose(const RandomScene& scene, const RandomBody& body) {
    const Eigen::Vector2d place = randomPlace(random_, scene.sand.parameters.grid.grid(), 0.0);
    return poseOf(place, randomHeight(random_, scene.sand, place, body.radius), randomRotation(random_));
  }
  /// A pose so high that no sand is near.
  Eigen::Isometry3d highPose(const RandomScene& scene, const RandomBody& body) {
    Eigen::Isometry3d pose = anyPose(scene, body);
    pose.translation().z() = highAbove(scene);
    return pose;
  }
  /// A pour that reaches the column at the body's origin, all the time.
  Pour pourOn(const RandomScene& scene, const RandomBody& body) {
    const double spacing = scene.sand.parameters.grid.spacing;
    Pour pour;
    pour.position = body.motion.front().pose.translation().head<2>();
    pour.radius = uniform(random_, 1.0, 4.0) * spacing;
    pour.rate = uniform(random_, 2.0, 10.0) * spacing * spacing * spacing / scene.frame;
    return pour;
  }

  std::mt19937 random_ = seededGenerator();
};

TEST_F(CudaBodies, HoverFarAboveAndComeDown) {
  RandomScene scene = sceneWith(2);
  for (RandomBody& body : scene.bodies) {
    body.motion = {{0.0, highPose(scene, body)},
                   {3.0 * scene.frame, highPose(scene, body)},
                   {7.0 * scene.frame, anyPose(scene, body)},
                   {10.0 * scene.frame, highPose(scene, body)}};
  }
  Pair pair(scene);
  pair.advance(scene.frame, 12);
}

TEST_F(CudaBodies, HoverFarAboveUnderAPour) {
  RandomScene scene = sceneWith(2);
  for (RandomBody& body : scene.bodies) body.motion = {{0.0, highPose(scene, body)}};
  scene.pours = {pourOn(scene, scene.bodies.front())};
  Pair pair(scene);
  pair.advance(scene.frame, 5);
  const Pour second = pourOn(scene, scene.bodies.back());
  pair.both([&](Simulator& simulator) { simulator.addPour(second); });
  pair.advance(scene.frame, 5);
}

TEST_F(CudaBodies, ArePlacedAnew) {
  const RandomScene scene = sceneWith(2);
  Pair pair(scene);
  for (int times = 0; times < 4; ++times) {
    pair.advance(scene.frame, 2);
    const std::size_t body = random_() % 2;
    const Eigen::Isometry3d pose =
        random_() % 3 == 0 ? highPose(scene, scene.bodies[body]) : anyPose(scene, scene.bodies[body]);
    pair.both([&](Simulator& simulator) { simulator.placeBody(body, pose); });
    expectSame(pair.cpu, pair.cuda);
  }
  pair.advance(scene.frame, 2);
}

TEST_F(CudaBodies, AreRemoved) {
  const RandomScene scene = sceneWith(3);
  Pair pair(scene);
  for (const std::size_t body : {1, 0, 2}) {
    pair.advance(scene.frame, 3);
    pair.both([&](Simulator& simulator) { simulator.removeBody(body); });
    expectSame(pair.cpu, pair.cuda);
  }
  pair.advance(scene.frame, 3);
}

TEST_F(CudaBodies, AreAddedOnTheWay) {
  RandomScene scene = sceneWith(3);
  const std::vector<RandomBody> late = std::move(scene.bodies);
  scene.bodies.clear();
  Pair pair(scene);
  for (const RandomBody& body : late) {
    pair.advance(scene.frame, 2);
    pair.both([&](Simulator& simulator) { addTo(simulator, body); });
    expectSame(pair.cpu, pair.cuda);
  }
  pair.advance(scene.frame, 4);
}

/// As a node does that hears of them one by one.
TEST_F(CudaBodies, MoveToPosesThatAreAppendedOnTheWay) {
  RandomScene scene = sceneWith(2);
  const std::vector<RandomBody> bodies = scene.bodies;
  for (RandomBody& body : scene.bodies) body.motion.clear();
  Pair pair(scene);
  for (int frame = 0; frame < 8; ++frame) {
    for (std::size_t body = 0; body < bodies.size(); ++body) {
      if (frame < 2 * static_cast<int>(body) || random_() % 3 == 0) continue;
      const Eigen::Isometry3d pose = anyPose(scene, bodies[body]);
      pair.both(
          [&](Simulator& simulator) { simulator.appendPose(body, simulator.time() + scene.frame, pose); });
    }
    pair.advance(scene.frame, 1);
  }
}

TEST_F(CudaBodies, CrossEachOther) {
  RandomScene scene = sceneWith(2);
  const Eigen::Isometry3d one = anyPose(scene, scene.bodies[0]);
  const Eigen::Isometry3d other = anyPose(scene, scene.bodies[0]);
  const double end = 6.0 * scene.frame;
  scene.bodies[0].motion = {{0.0, one}, {end, other}};
  scene.bodies[1].motion = {{0.0, other}, {end, one}};
  Pair pair(scene);
  pair.advance(scene.frame, 8);
}

/// Some of several that stand still.
TEST_F(CudaBodies, RestWhileOthersMove) {
  RandomScene scene = sceneWith(4, 1);
  for (RandomBody& body : scene.bodies) body.motion.resize(1);
  RandomBody& moving = scene.bodies.back();
  moving.motion.push_back({4.0 * scene.frame, moving.motion.front().pose});
  moving.motion.push_back({8.0 * scene.frame, anyPose(scene, moving)});
  Pair pair(scene);
  pair.advance(scene.frame, 12);
}

/// In sand that comes to rest around them, and is poured on afterwards.
TEST_F(CudaBodies, RestInSandThatRests) {
  RandomScene scene = sceneWith(0);
  RandomSand sand = heldSand(random_, 20, 12, 10.0);
  scene = randomScene(random_, std::move(sand), 0, 3);
  for (RandomBody& body : scene.bodies) body.motion.resize(1);
  scene.pours = {pourOn(scene, scene.bodies.front())};
  scene.pours.front().start = 6.0 * scene.frame;
  scene.pours.front().stop = 8.0 * scene.frame;
  Pair pair(scene);
  pair.advance(scene.frame, 12);
}

TEST_F(CudaBodies, LeaveTheMapAndComeBack) {
  RandomScene scene = sceneWith(2);
  for (RandomBody& body : scene.bodies) {
    Eigen::Isometry3d away = anyPose(scene, body);
    away.translation().x() -= 2.0 * scene.sand.parameters.grid.size.x();
    body.motion = {{0.0, anyPose(scene, body)},
                   {3.0 * scene.frame, away},
                   {6.0 * scene.frame, away},
                   {9.0 * scene.frame, anyPose(scene, body)}};
  }
  Pair pair(scene);
  pair.advance(scene.frame, 10);
}

TEST_F(CudaBodies, MoveInSandOfManyKinds) {
  RandomScene scene = sceneWith(2);
  varyMaterial(random_, scene.sand);
  Pair pair(scene);
  pair.advance(scene.frame, 8);
}

TEST_F(CudaBodies, OnlyDrag) {
  RandomScene scene = sceneWith(3, 1);
  scene.sand.parameters.coupling = Coupling::drag;
  scene.bodies.front().motion.resize(1);
  Pair pair(scene);
  pair.advance(scene.frame, 4);
  const Eigen::Isometry3d pose = anyPose(scene, scene.bodies[1]);
  pair.both([&](Simulator& simulator) { simulator.placeBody(1, pose); });
  pair.both([&](Simulator& simulator) { simulator.removeBody(2); });
  pair.advance(scene.frame, 4);
}

/// So fast that a list of placements is used up before the frame is over.
TEST_F(CudaBodies, MoveFasterThanAListOfPlacementsGoes) {
  RandomScene scene = sceneWith(1);
  RandomBody& body = scene.bodies.front();
  body.motion.clear();
  for (int key = 0; key <= 4; ++key) body.motion.push_back({2.0 * key * scene.frame, anyPose(scene, body)});
  Pair pair(scene);
  pair.advance(8.0 * scene.frame, 1);
}

}  // namespace
}  // namespace shallow_sand
