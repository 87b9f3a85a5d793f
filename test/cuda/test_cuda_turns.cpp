#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <utility>

#include "parity.h"
#include "random_edit.h"

/// The GPU takes steps by itself, while its program does something else or runs other sand.
namespace shallow_sand {
namespace {

class CudaTurns : public CudaTest {
 protected:
  RandomScene anyScene() { return tiltedScene(random_, {20, 12}, 1, 2); }

  std::mt19937 random_ = seededGenerator();
};

constexpr int kFrames = 4;

/// The fields after each frame of a simulation that is waited for.
std::vector<Fields> fieldsOfFrames(const RandomScene& scene) {
  Simulator simulator = simulatorOn(Backend::cpu, scene);
  std::vector<Fields> frames;
  for (int frame = 0; frame < kFrames; ++frame) {
    simulator.advanceTo((frame + 1) * scene.frame);
    frames.push_back(simulator.fields());
  }
  return frames;
}

TEST_F(CudaTurns, FieldsOfAFrameAreCollectedWhileTheNextOneRuns) {
  const RandomScene scene = anyScene();
  const std::vector<Fields> frames = fieldsOfFrames(scene);
  for (const Backend backend : {Backend::cpu, Backend::cuda}) {
    SCOPED_TRACE(toString(backend));
    Simulator simulator = simulatorOn(backend, scene);
    simulator.beginAdvanceTo(scene.frame);
    for (int frame = 0; frame + 1 < kFrames; ++frame) {
      simulator.requestFields();
      simulator.beginAdvanceTo((frame + 2) * scene.frame);
      expectSameBits(simulator.collectFields(), frames[static_cast<std::size_t>(frame)]);
    }
    expectSameBits(simulator.fields(), frames.back());
  }
}

TEST_F(CudaTurns, FieldsThatNobodyCollectsAreRequestedAgain) {
  const RandomScene scene = anyScene();
  const std::vector<Fields> frames = fieldsOfFrames(scene);
  Simulator simulator = simulatorOn(Backend::cuda, scene);
  for (int frame = 0; frame < kFrames; ++frame) {
    simulator.beginAdvanceTo((frame + 1) * scene.frame);
    simulator.requestFields();
    if (frame % 3 != 0) continue;
    expectSameBits(simulator.collectFields(), frames[static_cast<std::size_t>(frame)]);
    expectSameBits(simulator.collectFields(), frames[static_cast<std::size_t>(frame)]);
  }
  expectSameBits(simulator.collectFields(), frames.back());
}

/// Something that is asked of a simulator, or done to it.
struct Question {
  std::string name;
  std::function<void(Simulator&)> ask;
};

std::vector<Question> looks() {
  return {{"time", [](Simulator& s) { s.time(); }},
          {"progress", [](Simulator& s) { s.progress(); }},
          {"fields", [](Simulator& s) { s.fields(); }},
          {"requestFields", [](Simulator& s) { s.requestFields(); }},
          {"ledger", [](Simulator& s) { s.ledger(); }},
          {"maxSpeed", [](Simulator& s) { s.maxSpeed(); }},
          {"activeCells", [](Simulator& s) { s.activeCells(); }},
          {"bodyOverlap", [](Simulator& s) { s.bodyOverlap(); }},
          {"snapshot", [](Simulator& s) { s.snapshot(); }}};
}

std::vector<Question> changes(std::mt19937& random, const RandomScene& scene) {
  const Edit edit = randomEdit(random, scene.sand.parameters.grid.grid());
  const Pour pour = randomPour(random, scene);
  RandomBody body = randomBody(random, scene.sand.parameters.grid.spacing);
  moveThroughSand(random, scene.sand, 5.0 * scene.frame, body);
  const PoseKey& key = scene.bodies.front().motion.back();
  return {{"edit", [=](Simulator& s) { s.edit(edit); }},
          {"addPour", [=](Simulator& s) { s.addPour(pour); }},
          {"addBody", [=](Simulator& s) { addTo(s, body); }},
          {"placeBody", [=](Simulator& s) { s.placeBody(0, key.pose); }},
          {"removeBody", [](Simulator& s) { s.removeBody(1); }},
          {"beginAdvanceTo", [=](Simulator& s) { s.beginAdvanceTo(1.5 * scene.frame); }},
          {"advance", [=](Simulator& s) { s.advance(0.5 * scene.frame); }}};
}

TEST_F(CudaTurns, WhateverIsAskedWaits) {
  const RandomScene scene = anyScene();
  std::vector<Question> questions = looks();
  for (const Question& change : changes(random_, scene)) questions.push_back(change);
  for (const Question& question : questions) {
    SCOPED_TRACE(question.name);
    Simulator waited = simulatorOn(Backend::cpu, scene);
    waited.advanceTo(scene.frame);
    question.ask(waited);
    waited.advanceTo(2.0 * scene.frame);
    Simulator begun = simulatorOn(Backend::cuda, scene);
    begun.beginAdvanceTo(scene.frame);
    question.ask(begun);
    begun.beginAdvanceTo(2.0 * scene.frame);
    expectSame(waited, begun);
  }
}

/// A body's way is told while the run goes on in which it has no pose yet, or rests.
TEST_F(CudaTurns, PosesThatAreAppendedWhileItRunsAreForLater) {
  RandomScene scene = anyScene();
  const std::vector<PoseKey> ways[] = {scene.bodies[0].motion, scene.bodies[1].motion};
  scene.bodies[0].motion.resize(1);
  scene.bodies[1].motion.clear();
  const auto append = [&](Simulator& simulator) {
    for (const std::size_t body : {0, 1}) {
      for (std::size_t key = 1; key < 3; ++key)
        simulator.appendPose(body, (static_cast<double>(key) - 0.5) * scene.frame, ways[body][key].pose);
    }
  };
  Simulator waited = simulatorOn(Backend::cpu, scene);
  waited.advanceTo(scene.frame);
  append(waited);
  waited.advanceTo(2.0 * scene.frame);
  for (const Backend backend : {Backend::cpu, Backend::cuda}) {
    SCOPED_TRACE(toString(backend));
    Simulator begun = simulatorOn(backend, scene);
    begun.beginAdvanceTo(scene.frame);
    append(begun);
    begun.beginAdvanceTo(2.0 * scene.frame);
    expectSame(waited, begun);
  }
}

/// What is thrown if this is asked after a run was begun; empty if nothing is.
std::string thrown(Backend backend, const RandomScene& scene, const Question& question) {
  Simulator simulator = simulatorOn(backend, scene);
  simulator.beginAdvanceTo(0.0);
  try {
    simulator.beginAdvanceTo(scene.frame);
    question.ask(simulator);
  } catch (const InvalidParameter& problem) {
    return problem.what();
  }
  return "";
}

TEST_F(CudaTurns, WhateverIsAskedTellsThatAFixedStepIsTooLong) {
  RandomScene scene = tiltedScene(random_, {9, 6}, 0, 2);
  for (float& depth : scene.sand.depth) depth += static_cast<float>(scene.sand.parameters.grid.spacing);
  scene.sand.parameters.solver.fixed_step = 2.0 * scene.frame;
  scene.sand.parameters.solver.max_step = 10.0 * scene.frame;
  std::vector<Question> questions = looks();
  for (const Question& change : changes(random_, scene)) questions.push_back(change);
  for (const Question& question : questions) {
    SCOPED_TRACE(question.name);
    const std::string told = thrown(Backend::cpu, scene, question);
    EXPECT_EQ(told.rfind("solver.fixed_step", 0), 0u) << told;
    EXPECT_EQ(thrown(Backend::cuda, scene, question), told);
  }
}

/// After the error, too, both are the same.
TEST_F(CudaTurns, AFixedStepThatBecomesTooLongLeavesBothTheSame) {
  RandomScene scene = tiltedScene(random_, {20, 12}, 0, 1);
  Simulator simulator = simulatorOn(Backend::cpu, scene);
  simulator.advance(0.1 * scene.frame);
  scene.sand.parameters.solver.fixed_step = 0.9 * simulator.progress().last_step;
  Pair pair(scene);
  std::vector<std::string> told;
  pair.both([&](Simulator& either) {
    told.emplace_back();
    try {
      either.advance(10.0 * scene.frame);
    } catch (const InvalidParameter& problem) {
      told.back() = problem.what();
    }
  });
  EXPECT_EQ(told[0], told[1]);
  expectSame(pair.cpu, pair.cuda);
}

TEST_F(CudaTurns, TwoRunAtOnce) {
  const RandomScene one = anyScene();
  const RandomScene other = anyScene();
  Pair first(one);
  Pair second(other);
  for (int frame = 1; frame <= kFrames; ++frame) {
    first.both([&](Simulator& simulator) { simulator.beginAdvanceTo(frame * one.frame); });
    second.both([&](Simulator& simulator) { simulator.beginAdvanceTo(frame * other.frame); });
    expectSame(first.cpu, first.cuda);
    expectSame(second.cpu, second.cuda);
  }
}

TEST_F(CudaTurns, ARunGoesOnIfItsSimulatorMoves) {
  const RandomScene scene = anyScene();
  const std::vector<Fields> frames = fieldsOfFrames(scene);
  Simulator first = simulatorOn(Backend::cuda, scene);
  first.beginAdvanceTo(scene.frame);
  Simulator second = std::move(first);
  second.requestFields();
  second.beginAdvanceTo(2.0 * scene.frame);
  first = std::move(second);
  expectSameBits(first.collectFields(), frames[0]);
  expectSameBits(first.fields(), frames[1]);
}

TEST_F(CudaTurns, ASimulatorMayEndWhileItRuns) {
  const RandomScene scene = anyScene();
  for (int times = 0; times < 2; ++times) {
    Simulator simulator = simulatorOn(Backend::cuda, scene);
    simulator.advanceTo(scene.frame);
    simulator.requestFields();
    simulator.beginAdvanceTo(2.0 * scene.frame);
  }
}

}  // namespace
}  // namespace shallow_sand
