#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "random_seed.h"
#include "shallow_sand/ros/judgements.h"

namespace shallow_sand {
namespace {

bool says(const Judgement& judgement, const std::string& words) {
  return judgement.text.find(words) != std::string::npos;
}

TEST(JudgeSolver, WarnsExactlyWhenMoreThanATwentiethIsGivenUpAndSaysWhatToDo) {
  std::mt19937 random = seededGenerator();
  std::uniform_real_distribution<double> any(0.0, 1.0);
  for (int k = 0; k < 1000; ++k) {
    Pace pace;
    pace.asked = 0.01 + any(random);
    const double share = any(random);
    pace.simulated = share * pace.asked;
    const Judgement judgement = judgeSolver(pace, Status());
    if (std::abs(share - 0.95) < 1e-9) continue;
    EXPECT_EQ(judgement.level, share < 0.95 ? Judgement::warn : Judgement::ok) << share;
    EXPECT_EQ(says(judgement, "grid.spacing"), share < 0.95) << judgement.text;
  }
}

TEST(JudgeSolver, TellsTimeThatStandsStillFromTimeThatNeverBegan) {
  EXPECT_EQ(judgeSolver({}, Status()).level, Judgement::ok);
  EXPECT_TRUE(says(judgeSolver({}, Status()), "stands still"));
  EXPECT_EQ(judgeSolver({}, std::nullopt).level, Judgement::warn);
  EXPECT_TRUE(says(judgeSolver({}, std::nullopt), "/clock"));
}

TEST(JudgeSolver, SandThatIsPausedIsNoFault) {
  Status paused;
  paused.paused = true;
  EXPECT_EQ(judgeSolver({}, paused).level, Judgement::ok);
  EXPECT_TRUE(says(judgeSolver({}, paused), "~pause"));
}

TEST(JudgeVolume, LevelRisesWithTheError) {
  std::mt19937 random = seededGenerator();
  std::uniform_real_distribution<double> exponent(-12.0, 0.0);
  for (int k = 0; k < 1000; ++k) {
    Status status;
    status.volume_error = std::pow(10.0, exponent(random));
    const Judgement::Level expected = status.volume_error > 1e-3   ? Judgement::error
                                      : status.volume_error > 1e-6 ? Judgement::warn
                                                                   : Judgement::ok;
    EXPECT_EQ(judgeVolume(status).level, expected) << status.volume_error;
  }
  Status none;
  none.volume_error = std::nan("");
  EXPECT_EQ(judgeVolume(none).level, Judgement::error);
}

TEST(JudgeBodies, NamesThoseWithoutAPoseAndTheirProblemAndNoOthers) {
  std::mt19937 random = seededGenerator();
  for (int run = 0; run < 200; ++run) {
    Status status;
    int missing = 0;
    for (unsigned k = 0; k < random() % 12; ++k) {
      BodyStatus body;
      body.name = "body_" + std::string(1, static_cast<char>('a' + k));
      body.state = static_cast<std::uint8_t>(random() % 4);
      body.problem = "problem_" + std::string(1, static_cast<char>('a' + k));
      status.bodies.push_back(body);
    }
    const Judgement judgement = judgeBodies(status);
    for (const BodyStatus& body : status.bodies) {
      const bool is_missing = body.state == BodyStatus::WAITING || body.state == BodyStatus::STALE;
      missing += is_missing ? 1 : 0;
      EXPECT_EQ(says(judgement, body.name + " "), is_missing && missing <= 5) << judgement.text;
      EXPECT_EQ(says(judgement, body.problem), is_missing && missing <= 5) << judgement.text;
    }
    EXPECT_EQ(judgement.level, missing > 0 ? Judgement::warn : Judgement::ok);
    EXPECT_EQ(judgement.figures.size(), static_cast<std::size_t>(missing)) << "all are told of there";
    EXPECT_EQ(says(judgement, "and " + std::to_string(missing - 5) + " more"), missing > 5);
  }
}

TEST(JudgeBackend, WarnsOnlyWhereAutoFellBackFromWhatTheBuildHas) {
  for (const Backend wanted : {Backend::automatic, Backend::cpu, Backend::cuda}) {
    for (const Backend used : {Backend::cpu, Backend::cuda}) {
      for (const bool has_cuda : {false, true}) {
        const Judgement judgement = judgeBackend(wanted, used, "no usable GPU (why): running", has_cuda);
        const bool fell_back = wanted == Backend::automatic && used == Backend::cpu && has_cuda;
        EXPECT_EQ(judgement.level, fell_back ? Judgement::warn : Judgement::ok);
        EXPECT_TRUE(says(judgement, "why"));
        EXPECT_EQ(says(judgement, "backend: cpu"), fell_back);
      }
    }
  }
}

TEST(JudgePublishers, NamesEveryTopicThatIsSilent) {
  EXPECT_EQ(judgePublishers({}).level, Judgement::ok);
  const Judgement both = judgePublishers({"~height_field stays silent", "~points stays silent"});
  EXPECT_EQ(both.level, Judgement::warn);
  for (const char* words : {"~height_field", "~points", "grid.spacing"})
    EXPECT_TRUE(says(both, words)) << both.text;
}

}  // namespace
}  // namespace shallow_sand
