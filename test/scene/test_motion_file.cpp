#include <gtest/gtest.h>

#include <fstream>
#include <random>
#include <sstream>

#include "random_seed.h"
#include "shallow_sand/scene/scene.h"
#include "temporary_folder.h"

namespace shallow_sand {
namespace {

/// A scene beside the file `poses.yaml`, which its body's motion names.
class MotionFile : public testing::Test {
 protected:
  Scene load(const std::string& poses) {
    std::ofstream(folder_.path() / "poses.yaml") << poses;
    return loadWith("{file: poses.yaml}");
  }
  Scene loadWith(const std::string& motion) {
    const std::string path = (folder_.path() / "scene.yaml").string();
    std::ofstream(path) << "bodies:\n  - {name: blade, shape: {sphere: 0.1}, motion: " << motion << "}\n";
    return loadScene(path);
  }
  template <class Call>
  std::string errorOf(const Call& call) {
    try {
      call();
    } catch (const SceneError& error) {
      return error.what();
    }
    return "no error";
  }
  TemporaryFolder folder_;
};

TEST_F(MotionFile, HoldsWhatASceneWould) {
  std::mt19937 random = seededGenerator();
  std::uniform_real_distribution<double> any(-100.0, 100.0);
  std::ostringstream poses;
  double time = any(random);
  for (int k = 0; k < 50; ++k) {
    time += 0.001 + std::abs(any(random));
    poses << "- {time: " << time << ", position: [" << any(random) << ", " << any(random) << ", "
          << any(random) << "], rpy: [" << any(random) << ", 0, " << any(random) << "]}\n";
  }
  const Scene from_file = load(poses.str());
  std::string inlined = "\n";
  std::istringstream lines(poses.str());
  for (std::string line; std::getline(lines, line);) inlined += line.substr(2) + ",\n";
  const Scene from_scene = loadWith("[" + inlined + "]");
  const auto& one = from_file.bodies.at(0).motion;
  const auto& other = from_scene.bodies.at(0).motion;
  ASSERT_EQ(one.size(), 50u);
  ASSERT_EQ(other.size(), one.size());
  for (std::size_t k = 0; k < one.size(); ++k) {
    EXPECT_EQ(one[k].time, other[k].time);
    EXPECT_EQ(one[k].pose.matrix(), other[k].pose.matrix());
  }
}

TEST_F(MotionFile, ErrorsNameItAndTheLine) {
  const std::string wrong =
      errorOf([&] { load("- {time: 0, position: [0, 0, 0]}\n- {time: 0, position: [0, 0, 0]}\n"); });
  EXPECT_NE(wrong.find("poses.yaml:2: [1].time: 0; expected a time after"), std::string::npos) << wrong;
  const std::string nested = errorOf([&] { load("- {file: poses.yaml}\n"); });
  EXPECT_NE(nested.find("poses.yaml:1: [0]"), std::string::npos) << nested;
  const std::string none = errorOf([&] { load("time: 0\n"); });
  EXPECT_NE(none.find("poses.yaml: expected a list of poses"), std::string::npos) << none;
  const std::string empty = errorOf([&] { load("[]\n"); });
  EXPECT_NE(empty.find("at least one pose"), std::string::npos) << empty;
  const std::string torn = errorOf([&] { load("- {time: 0,\n"); });
  EXPECT_NE(torn.find("not valid YAML"), std::string::npos) << torn;
}

TEST_F(MotionFile, IsAFileThatEnds) {
  for (const char* path : {"nowhere.yaml", "/dev/zero", "."}) {
    const std::string error = errorOf([&] { loadWith(std::string("{file: ") + path + "}"); });
    EXPECT_NE(error.find("scene.yaml:2: bodies[0].motion.file: "), std::string::npos) << error;
    EXPECT_NE(error.find("expected a file with a list of poses"), std::string::npos) << error;
  }
}

}  // namespace
}  // namespace shallow_sand
