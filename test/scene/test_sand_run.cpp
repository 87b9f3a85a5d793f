#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>

namespace {

struct Outcome {
  int exit_code = -1;
  std::string errors;  ///< what went to stderr
};

std::string contentsOf(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

Outcome sandRun(const std::string& arguments) {
  const std::string command =
      std::string(SAND_RUN_EXECUTABLE) + " " + arguments + " >sand_run.out 2>sand_run.err";
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, contentsOf("sand_run.err")};
}

constexpr const char* kSmallScene = R"(
grid: {size: [0.8, 0.5], spacing: 0.02}
material: {friction_angle: 30.0}
sand: [{depth: 0.1}, {cylinder: {center: [0.3, 0.25], radius: 0.1, depth: 0.1}}]
pours: [{position: [0.5, 0.25], radius: 0.05, rate: 0.001}]
duration: 0.33
)";

std::string sceneFile(const std::string& text) {
  std::ofstream("small.yaml") << text;
  return "small.yaml";
}

/// Bad input: exit code 2, and one line that holds `words`.
void expectRefused(const std::string& arguments, const std::string& words) {
  const Outcome outcome = sandRun(arguments);
  EXPECT_EQ(outcome.exit_code, 2) << arguments << "\n" << outcome.errors;
  EXPECT_EQ(std::count(outcome.errors.begin(), outcome.errors.end(), '\n'), 1) << arguments << "\n"
                                                                               << outcome.errors;
  EXPECT_NE(outcome.errors.find(words), std::string::npos) << arguments << "\n" << outcome.errors;
}

TEST(SandRun, RefusesBadArguments) {
  const std::string scene = sceneFile(kSmallScene);
  expectRefused("", "SCENE");
  expectRefused(scene + " --colour red", "--colour");
  expectRefused(scene + " more.yaml", "more.yaml");
  expectRefused(scene + " --dur 0.1", "--dur");
  expectRefused(scene + " --duration", "--duration");
  expectRefused(scene + " --duration long", "--duration");
  expectRefused(scene + " --duration -1", "--duration");
  expectRefused(scene + " --duration nan", "--duration");
  expectRefused(scene + " --threads -2", "--threads");
  expectRefused(scene + " --threads two", "--threads");
  expectRefused(scene + " --backend tpu", "auto, cpu or cuda");
}

TEST(SandRun, RefusesBadFilesBeforeItRuns) {
  const std::string scene = sceneFile(kSmallScene);
  expectRefused("no_such_scene.yaml", "no_such_scene.yaml");
  for (const std::string option : {"--save", "--report", "--picture"}) {
    expectRefused(scene + " --duration 1e9 " + option + " no_such_folder/result", "no_such_folder");
    expectRefused(scene + " --duration 1e9 " + option + " .", option);
  }
  expectRefused(scene + " --duration 1e9 --mesh no_such_folder/result.stl", "no_such_folder");
  expectRefused(scene + " --duration 1e9 --mesh sand.obj", "--mesh: sand.obj; expected a file that ends in");
}

TEST(SandRun, RefusesBadScenes) {
  expectRefused(sceneFile("grid: {spacing: -1}"), "small.yaml:1: grid.spacing: -1; expected");
  expectRefused(sceneFile("grid: {spacing: [}"), "small.yaml:1");
  expectRefused(sceneFile("sand: [{file: dem.tif, as: depth}]"),
                "small.yaml:1: sand[0].file: ./dem.tif is no file");
  expectRefused(sceneFile("pours: [{position: [90, 90], rate: 1}]"), "pours[0].position");
  expectRefused(
      sceneFile("{solver: {fixed_step: 0.5}, sand: [{cylinder: {center: [2, 1], radius: 0.5, depth: 1}}]}") +
          " --backend cpu --duration 5",
      "fixed_step");
}

TEST(SandRun, WritesWhatItPromises) {
  const std::string scene = sceneFile(kSmallScene);
  const Outcome outcome =
      sandRun(scene + " --backend cpu --threads 1 --save s.tif --report r.json --picture p.png --mesh m.ply");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  const auto report = nlohmann::json::parse(contentsOf("r.json"));
  std::set<std::string> keys;
  for (const auto& item : report.items()) {
    keys.insert(item.key());
  }
  const std::set<std::string> promised{"scene",
                                       "backend",
                                       "threads",
                                       "cells",
                                       "steps",
                                       "simulated_s",
                                       "wall_s",
                                       "cell_updates",
                                       "cell_updates_per_s",
                                       "active_cells_end",
                                       "max_speed_end",
                                       "volume_start_m3",
                                       "volume_poured_m3",
                                       "volume_left_m3",
                                       "volume_end_m3",
                                       "volume_error",
                                       "body_overlap_m3"};
  EXPECT_EQ(keys, promised);
  EXPECT_EQ(report["scene"], "small");
  EXPECT_EQ(report["backend"], "cpu");
  EXPECT_EQ(report["threads"], 1);
  EXPECT_EQ(report["cells"], 40 * 25);
  EXPECT_NEAR(report["simulated_s"].get<double>(), 0.33, 1e-9);
  EXPECT_GT(report["steps"].get<int>(), 30);
  EXPECT_NEAR(report["volume_poured_m3"].get<double>(), 0.33e-3, 1e-8);
  EXPECT_LT(report["volume_error"].get<double>(), 1e-6);
  EXPECT_FALSE(contentsOf("s.tif").empty());
  EXPECT_FALSE(contentsOf("p.png").empty());
  EXPECT_EQ(contentsOf("m.ply").rfind("ply\n", 0), 0u);
}

TEST(SandRun, TellsHowManyGrainsThereAre) {
  const std::string scene = sceneFile(std::string(kSmallScene) + "grains: {per_cell: 3, layers: 2}\n");
  const Outcome outcome = sandRun(scene + " --backend cpu --report grains.json --picture grains.png");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_EQ(nlohmann::json::parse(contentsOf("grains.json")).at("grains"), 40 * 25 * 18);
}

TEST(SandRun, SaysWhatItCanDo) {
  EXPECT_EQ(sandRun("--help").exit_code, 0);
  EXPECT_EQ(sandRun("--version").exit_code, 0);
}

TEST(SandRun, GoesOnFromASavedState) {
  const std::string scene = sceneFile(kSmallScene);
  ASSERT_EQ(sandRun(scene + " --duration 0.3 --save whole.tif --report whole.json").exit_code, 0);
  ASSERT_EQ(sandRun(scene + " --duration 0.15 --save half.tif").exit_code, 0);
  const Outcome resumed =
      sandRun(scene + " --duration 0.3 --load half.tif --save resumed.tif --report resumed.json");
  ASSERT_EQ(resumed.exit_code, 0) << resumed.errors;
  const nlohmann::json whole = nlohmann::json::parse(contentsOf("whole.json"));
  const nlohmann::json second = nlohmann::json::parse(contentsOf("resumed.json"));
  for (const char* key : {"steps", "volume_end_m3", "max_speed_end", "active_cells_end", "simulated_s"})
    EXPECT_EQ(whole.at(key), second.at(key)) << key;
  expectRefused(scene + " --load missing.tif", "missing.tif: ");
}

}  // namespace
