#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "mirrored_field.h"
#include "random_bodies.h"
#include "random_fields.h"
#include "random_seed.h"

namespace shallow_sand {
namespace {

constexpr int kScenes = 12;

/// Large enough for the bodies, and no multiple of anything.
int randomCount(std::mt19937& random) { return 30 + static_cast<int>(random() % 20); }

/// Sand that rests, and covers most of its bed.
RandomSand restingSand(std::mt19937& random) {
  const int columns = randomCount(random);
  return heldSand(random, columns, randomCount(random), uniform(random, 2.0, 12.0));
}

/// Sand that rests, so deep that none of it comes to lie on bare rock: a film on rock steeper than the
/// friction angle runs off more and more slowly, but for ever.
RandomSand deepRestingSand(std::mt19937& random) {
  const int columns = randomCount(random);
  return heldSand(random, columns, randomCount(random), uniform(random, 30.0, 40.0));
}

/// Uneven sand of which much moves at once.
RandomSand movingSand(std::mt19937& random) {
  const int columns = randomCount(random);
  RandomSand sand = randomSand(random, columns, randomCount(random));
  sand.parameters.gravity = randomGravity(random, 3.0);
  return sand;
}

double highestSurface(const RandomSand& sand) {
  double highest = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < sand.bed.size(); ++k) {
    highest = std::max(highest, static_cast<double>(sand.bed[k]) + static_cast<double>(sand.depth[k]));
  }
  return highest;
}

/// Flies at random over the sand, its lowest point `gap` [m] over the highest surface.
void hover(std::mt19937& random, const RandomSand& sand, double gap, double stop, RandomBody& body) {
  const double height = highestSurface(sand) + gap + body.radius;
  for (int key = 0; key < 4; ++key) {
    body.motion.push_back({stop * key / 3.0, poseOf(randomPlace(random, sand.parameters.grid.grid(), 0.0),
                                                    height, randomRotation(random))});
  }
}

/// A place in the sand, held for ever.
void rest(std::mt19937& random, const RandomSand& sand, RandomBody& body) {
  const Eigen::Vector2d place = randomPlace(random, sand.parameters.grid.grid(), body.radius);
  const double height = surfaceNear(sand, place) + uniform(random, -1.0, 1.0) * body.radius;
  body.motion = {{0.0, poseOf(place, height, randomRotation(random))}};
}

double speedScale(const RandomSand& sand) { return std::sqrt(9.81 * sand.parameters.grid.spacing); }

/// Time in which a body of this speed crosses the grid. [s]
double randomDuration(std::mt19937& random, const RandomSand& sand) {
  return sand.parameters.grid.size.maxCoeff() / (uniform(random, 0.3, 5.0) * speedScale(sand));
}

void expectSameSand(const Fields& a, const Fields& b, int scene) {
  EXPECT_TRUE(sameBits(a.depth, b.depth)) << "scene " << scene;
  // A zero may have either sign.
  EXPECT_EQ(a.momentum_x, b.momentum_x) << "scene " << scene;
  EXPECT_EQ(a.momentum_y, b.momentum_y) << "scene " << scene;
}

TEST(CouplingLaws, HoveringBodyLeavesRestingSandAlone) {
  std::mt19937 random = seededGenerator();
  for (int scene = 0; scene < kScenes; ++scene) {
    const RandomSand sand = restingSand(random);
    Simulator simulator(sand.parameters, sand.bed, sand.depth);
    for (int k = 0; k < 3; ++k) {
      RandomBody body = randomBody(random, sand.parameters.grid.spacing);
      hover(random, sand, uniform(random, 0.001, 1.5) * sand.parameters.grid.spacing, 0.5, body);
      addTo(simulator, body);
    }
    simulator.advance(0.6);
    const Fields after = simulator.fields();
    EXPECT_TRUE(sameBits(after.depth, sand.depth)) << "scene " << scene;
    EXPECT_EQ(simulator.activeCells(), 0u) << "scene " << scene;
    EXPECT_EQ(simulator.bodyOverlap(), 0.0);
  }
}

TEST(CouplingLaws, HoveringBodyLeavesMovingSandAlone) {
  std::mt19937 random = seededGenerator();
  for (int scene = 0; scene < kScenes; ++scene) {
    const RandomSand sand = movingSand(random);
    Simulator alone(sand.parameters, sand.bed, sand.depth);
    Simulator simulator(sand.parameters, sand.bed, sand.depth);
    RandomBody body = randomBody(random, sand.parameters.grid.spacing);
    // Waves may climb, but not by as much as this in the time given.
    hover(random, sand, sand.parameters.grid.size.maxCoeff(), 0.2, body);
    addTo(simulator, body);
    alone.advance(0.2);
    simulator.advance(0.2);
    EXPECT_EQ(simulator.progress().steps, alone.progress().steps);
    expectSameSand(simulator.fields(), alone.fields(), scene);
  }
}

/// What changed from one moment to another, in all columns and in the one that changed most.
struct Change {
  double part_of_all;  ///< sum of changes over the sum of depths
  double most;         ///< [m]
};

Change changeBetween(const Fields& before, const Fields& after) {
  double sum = 0.0;
  double depths = 0.0;
  double most = 0.0;
  for (std::size_t k = 0; k < before.depth.size(); ++k) {
    const double change = std::abs(static_cast<double>(after.depth[k]) - before.depth[k]) +
                          std::abs(static_cast<double>(after.load[k]) - before.load[k]);
    sum += change;
    depths += after.depth[k] + after.load[k];
    most = std::max(most, change);
  }
  return {sum / depths, most};
}

/// Films on a body's steep sides trickle on, more and more slowly, as they do on rock. A second in which
/// something moved once moved 1e-6 of the sand and 0.011 cells of a column at most, in 480 scenes; in the
/// first seconds it is a thousand times as much.
TEST(CouplingLaws, SandSettlesAroundARestingBodyAndStays) {
  std::mt19937 random = seededGenerator();
  for (int scene = 0; scene < kScenes; ++scene) {
    const RandomSand sand = deepRestingSand(random);
    Simulator simulator(sand.parameters, sand.bed, sand.depth);
    RandomBody body = randomBody(random, sand.parameters.grid.spacing);
    rest(random, sand, body);
    addTo(simulator, body);
    simulator.advance(20.0);
    const Fields settled = simulator.fields();
    simulator.advance(1.0);
    const Change change = changeBetween(settled, simulator.fields());
    EXPECT_LT(change.part_of_all, 1e-5) << "scene " << scene;
    EXPECT_LT(change.most, 0.05 * sand.parameters.grid.spacing) << "scene " << scene;
  }
}

/// A box that is pushed along y and rolls about x, through a bed of even depth, in the middle of the grid:
/// everything is its own mirror image. Lengths are binary fractions and the middles of columns lie on samples
/// of the distance field, so that left and right are rounded alike.
TEST(CouplingLaws, WakeOfAMirrorSymmetricBodyIsMirrorSymmetricInEveryBit) {
  std::mt19937 random = seededGenerator();
  for (int scene = 0; scene < kScenes; ++scene) {
    SimulatorParameters parameters;
    const int columns = 31 + 2 * static_cast<int>(random() % 5);
    const double spacing = 1.0 / 32.0;
    parameters.grid.size = {columns * spacing, 40 * spacing};
    parameters.grid.spacing = spacing;
    parameters.material.friction_angle = uniform(random, 10.0, 50.0) * M_PI / 180.0;
    parameters.backend = Backend::cpu;
    const Grid grid = parameters.grid.grid();
    const float depth = static_cast<float>(uniform(random, 2.0, 8.0) * spacing);
    Simulator simulator(parameters, std::vector<float>(grid.cells(), 0.0f),
                        std::vector<float>(grid.cells(), depth));

    const auto cells = [&](int least, int most) {
      return spacing * (least + static_cast<int>(random() % static_cast<unsigned>(most - least + 1)));
    };
    const TriangleMesh box = triangulate(Box{{cells(4, 10), cells(4, 8), cells(4, 8)}});
    const std::size_t body = simulator.addBody("box", std::make_shared<const DistanceField>(mirroredField(
                                                          computeDistanceField(box, 0.5 * spacing), 0)));
    const double middle = 0.5 * columns * spacing;
    const double height = uniform(random, 0.3, 1.5) * depth;
    const double turn = uniform(random, -1.0, 1.0);  // about x, which leaves it mirror symmetric
    const double speed = uniform(random, 0.1, 2.0);
    const double rate = uniform(random, -6.0, 6.0);
    for (const double time : {0.0, 0.1, 0.2, 0.3}) {
      simulator.appendPose(body, time,
                           Eigen::Translation3d(middle, 10.0 * spacing + speed * time, height) *
                               Eigen::AngleAxisd(turn + rate * time, Eigen::Vector3d::UnitX()));
    }
    simulator.advance(0.6);
    const Fields fields = simulator.fields();
    for (int j = 0; j < grid.rows; ++j) {
      for (int i = 0; i < grid.columns; ++i) {
        const std::size_t k = grid.index(i, j);
        const std::size_t other = grid.index(grid.columns - 1 - i, j);
        ASSERT_EQ(fields.depth[k], fields.depth[other]) << "scene " << scene;
        ASSERT_EQ(fields.momentum_x[k], -fields.momentum_x[other]) << "scene " << scene;
        ASSERT_EQ(fields.momentum_y[k], fields.momentum_y[other]) << "scene " << scene;
      }
    }
  }
}

/// A box somewhere in a bed of even depth, that travels and spins about an upright axis.
struct SpinningBox {
  Eigen::Vector2d from;
  Eigen::Vector2d velocity;
  double height;
  double turn;
  double rate;  ///< [rad/s]
};

SpinningBox mirrored(SpinningBox box, double width) {
  box.from.x() = width - box.from.x();
  box.velocity.x() = -box.velocity.x();
  box.turn = -box.turn;
  box.rate = -box.rate;
  return box;
}

Fields wakeOf(const SpinningBox& box, const SimulatorParameters& parameters, float depth,
              const std::shared_ptr<const DistanceField>& field) {
  const std::size_t cells = parameters.grid.grid().cells();
  Simulator simulator(parameters, std::vector<float>(cells, 0.0f), std::vector<float>(cells, depth));
  const std::size_t body = simulator.addBody("box", field);
  for (const double time : {0.0, 0.1, 0.2, 0.3}) {
    const Eigen::Vector2d place = box.from + time * box.velocity;
    simulator.appendPose(body, time,
                         Eigen::Translation3d(place.x(), place.y(), box.height) *
                             Eigen::AngleAxisd(box.turn + box.rate * time, Eigen::Vector3d::UnitZ()));
  }
  simulator.advance(0.6);
  return simulator.fields();
}

/// Positions in the body's frame are rounded, and not alike on both sides, so a column at a body's edge may
/// be inside on one side only. What the wakes differ by must stay a small part of what the body changed.
TEST(CouplingLaws, MirroredSpinMakesTheMirroredWake) {
  std::mt19937 random = seededGenerator();
  double largest = 0.0;
  for (int scene = 0; scene < kScenes; ++scene) {
    SimulatorParameters parameters;
    const double spacing = 1.0 / 32.0;
    const int columns = 48;
    parameters.grid.size = {columns * spacing, columns * spacing};
    parameters.grid.spacing = spacing;
    parameters.backend = Backend::cpu;
    const float depth = static_cast<float>(uniform(random, 3.0, 8.0) * spacing);
    const double side = uniform(random, 5.0, 10.0) * spacing;
    const Eigen::Vector3d size(side, uniform(random, 5.0, 10.0) * spacing, 10.0 * spacing);
    const auto field =
        std::make_shared<const DistanceField>(computeDistanceField(triangulate(Box{size}), 0.5 * spacing));
    const double speed = uniform(random, -0.5, 0.5);
    const SpinningBox box{{uniform(random, 0.6, 0.9), uniform(random, 0.6, 0.9)},
                          {speed, uniform(random, -0.5, 0.5)},
                          depth + uniform(random, 0.1, 0.9) * 5.0 * spacing,
                          uniform(random, -M_PI, M_PI),
                          uniform(random, -6.0, 6.0)};
    const Fields own = wakeOf(box, parameters, depth, field);
    const Fields other = wakeOf(mirrored(box, columns * spacing), parameters, depth, field);
    const Grid grid = parameters.grid.grid();
    double difference = 0.0;
    double changed = 0.0;
    for (int j = 0; j < grid.rows; ++j) {
      for (int i = 0; i < grid.columns; ++i) {
        const double here = own.depth[grid.index(i, j)];
        const double there = other.depth[grid.index(grid.columns - 1 - i, j)];
        difference += std::abs(here - there);
        changed += std::abs(here - static_cast<double>(depth));
      }
    }
    ASSERT_GT(changed, 0.0);
    largest = std::max(largest, difference / changed);
    EXPECT_LT(difference, 0.02 * changed) << "scene " << scene;
  }
  std::printf("wakes and mirrored wakes differ by at most %.2e of what was changed\n", largest);
}

TEST(CouplingLaws, VolumeIsKeptAndDepthNeverNegative) {
  std::mt19937 random = seededGenerator();
  for (int scene = 0; scene < kScenes; ++scene) {
    RandomSand sand = movingSand(random);
    sand.parameters.edges = randomEdges(random);
    sand.parameters.solver.courant = uniform(random, 0.1, 0.9);
    Simulator simulator(sand.parameters, sand.bed, sand.depth);
    const double duration = randomDuration(random, sand);
    for (int k = 0; k < 3; ++k) {
      RandomBody body = randomBody(random, sand.parameters.grid.spacing);
      moveThroughSand(random, sand, duration, body);
      addTo(simulator, body);
    }
    for (int frame = 0; frame < 10; ++frame) {
      simulator.advance(0.1 * duration);
      const Fields fields = simulator.fields();
      for (std::size_t k = 0; k < fields.depth.size(); ++k) {
        ASSERT_TRUE(std::isfinite(fields.depth[k]) && fields.depth[k] >= 0.0f)
            << fields.depth[k] << " scene " << scene;
        ASSERT_TRUE(std::isfinite(fields.momentum_x[k]) && std::isfinite(fields.momentum_y[k]))
            << "scene " << scene;
      }
    }
    EXPECT_LT(simulator.ledger().error(), 1e-6) << "scene " << scene;
  }
}

TEST(CouplingLaws, NoSandIsInsideBodiesThatStopped) {
  std::mt19937 random = seededGenerator();
  double largest = 0.0;
  for (int scene = 0; scene < kScenes; ++scene) {
    const RandomSand sand = restingSand(random);
    Simulator simulator(sand.parameters, sand.bed, sand.depth);
    const double duration = randomDuration(random, sand);
    const int bodies = 1 + scene % 3;
    for (int k = 0; k < bodies; ++k) {
      RandomBody body = randomBody(random, sand.parameters.grid.spacing);
      moveThroughSand(random, sand, duration, body);
      addTo(simulator, body);
    }
    simulator.advance(duration + 2.0);
    const double cells = simulator.bodyOverlap() / std::pow(sand.parameters.grid.spacing, 3);
    largest = std::max(largest, cells);
    EXPECT_LT(cells, 1e-3) << "cubes of a cell, scene " << scene << ", " << bodies << " bodies";
  }
  std::printf("largest overlap: %.2e cubes of a cell\n", largest);
}

TEST(CouplingLaws, ThreadsChangeNoBit) {
  std::mt19937 random = seededGenerator();
  for (int scene = 0; scene < kScenes; ++scene) {
    RandomSand sand = movingSand(random);
    sand.parameters.edges = randomEdges(random);
    std::vector<RandomBody> bodies;
    for (int k = 0; k < 2; ++k) {
      bodies.push_back(randomBody(random, sand.parameters.grid.spacing));
      moveThroughSand(random, sand, 0.4, bodies.back());
    }
    std::vector<Simulator> simulators;
    for (const int threads : {1, 2, 3}) {
      sand.parameters.threads = threads;
      simulators.emplace_back(sand.parameters, sand.bed, sand.depth);
      for (const RandomBody& body : bodies) addTo(simulators.back(), body);
      simulators.back().advance(0.2);
      const Fields one = simulators.front().fields();
      const Fields many = simulators.back().fields();
      EXPECT_TRUE(sameBits(one.depth, many.depth)) << threads << " threads, scene " << scene;
      EXPECT_TRUE(sameBits(one.momentum_x, many.momentum_x)) << threads << " threads, scene " << scene;
      EXPECT_TRUE(sameBits(one.momentum_y, many.momentum_y)) << threads << " threads, scene " << scene;
      EXPECT_EQ(simulators.front().bodyOverlap(), simulators.back().bodyOverlap());
    }
  }
}

/// A column of sand that falls somewhere at once.
Edit randomShower(std::mt19937& random, const RandomSand& sand) {
  Edit edit;
  edit.region.center = randomPlace(random, sand.parameters.grid.grid(), 0.0);
  edit.region.radius = uniform(random, 1.0, 10.0) * sand.parameters.grid.spacing;
  edit.operation = EditOperation::add;
  edit.value = uniform(random, 0.1, 5.0) * sand.parameters.grid.spacing;
  return edit;
}

/// What rests is not computed; bodies come to rest in the sand and above it, and sand falls on them and
/// beside them while they rest.
TEST(CouplingLaws, LeavingOutWhatRestsChangesNoBit) {
  std::mt19937 random = seededGenerator();
  std::uint64_t computed = 0;
  std::uint64_t all = 0;
  for (int scene = 0; scene < kScenes; ++scene) {
    const RandomSand sand = restingSand(random);
    SimulatorParameters awake = sand.parameters;
    awake.sleeping = false;
    Simulator sleeping(sand.parameters, sand.bed, sand.depth);
    Simulator complete(awake, sand.bed, sand.depth);
    const int bodies = 1 + static_cast<int>(random() % 3);
    for (int k = 0; k < bodies; ++k) {
      RandomBody body = randomBody(random, sand.parameters.grid.spacing);
      if (random() % 3 == 0) {
        hover(random, sand, uniform(random, 0.1, 20.0) * sand.parameters.grid.spacing, 0.2, body);
      } else {
        moveThroughSand(random, sand, 0.2, body);
      }
      for (Simulator* simulator : {&sleeping, &complete}) addTo(*simulator, body);
    }
    for (int frame = 0; frame < 6; ++frame) {
      const Edit shower = randomShower(random, sand);
      const double duration = uniform(random, 0.1, 2.0);
      for (Simulator* simulator : {&sleeping, &complete}) {
        if (frame == 2 || frame == 4) simulator->edit(shower);
        simulator->advance(duration);
      }
      const Fields one = sleeping.fields();
      const Fields other = complete.fields();
      expectSameSand(one, other, scene);
      EXPECT_TRUE(sameBits(one.load, other.load)) << "scene " << scene;
      EXPECT_EQ(sleeping.progress().steps, complete.progress().steps) << "scene " << scene;
    }
    computed += sleeping.progress().cell_updates;
    all += complete.progress().cell_updates;
  }
  EXPECT_LT(computed, all);
}

}  // namespace
}  // namespace shallow_sand
