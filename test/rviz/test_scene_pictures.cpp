#include <gtest/gtest.h>
#include <ros/ros.h>
#include <ros/topic.h>
#include <rviz/visualization_manager.h>
#include <signal.h>

#include <QProcess>
#include <algorithm>
#include <cmath>
#include <string>

#include "rviz/rviz_window.h"
#include "rviz/sand_colors.h"
#include "shallow_sand/Status.h"

namespace shallow_sand {
namespace {

RvizWindow* window = nullptr;
const std::string kConfig = std::string(SHALLOW_SAND_SOURCE_DIR) + "/config/";

struct ScenePicture {
  const char* name;
  double time;         ///< of the sand when the picture is taken [s]
  double least_share;  ///< of pixels that have the colour of sand
};

std::ostream& operator<<(std::ostream& out, const ScenePicture& scene) { return out << scene.name; }

/// roslaunch and all it started, until this goes.
class Launch {
 public:
  explicit Launch(const std::string& scene) {
    process_.setProcessChannelMode(QProcess::ForwardedChannels);
    process_.start("roslaunch",
                   {"shallow_sand", "scene.launch", QString::fromStdString("name:=" + scene), "rviz:=false"});
  }
  ~Launch() {
    if (process_.state() == QProcess::NotRunning) return;
    ::kill(static_cast<pid_t>(process_.processId()), SIGINT);
    if (!process_.waitForFinished(20000)) process_.kill();
  }

 private:
  QProcess process_;
};

class ScenePictures : public testing::TestWithParam<ScenePicture> {};

TEST_P(ScenePictures, ShowSandWithLightAndShadow) {
  const ScenePicture scene = GetParam();
  const Launch launch(scene.name);
  Status::ConstPtr status;
  ros::NodeHandle node;
  const ros::Subscriber subscriber = node.subscribe<Status>(
      "/sand_node/status", 1, [&](const Status::ConstPtr& message) { status = message; });
  window->load(kConfig + "scenes/" + scene.name + ".rviz");
  ASSERT_NE(window->sand(), nullptr);
  ASSERT_TRUE(window->runUntil([&] { return status && status->simulated_time >= scene.time; }, 60.0))
      << "the sand did not run on to " << scene.time << " s";
  EXPECT_TRUE(window->runUntil([&] { return shareOfSand(window->picture()) > scene.least_share; }, 20.0))
      << "no sand is to be seen";
  EXPECT_EQ(window->errors(), "");

  const QImage picture = window->picture();
  const std::string file = std::string(PICTURES) + scene.name + ".png";
  ASSERT_TRUE(picture.save(QString::fromStdString(file))) << file;
  double sand = 0.0;
  double sum = 0.0;
  double squares = 0.0;
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) {
      if (!isSand(picture.pixel(x, y))) continue;
      const double brightness = qGray(picture.pixel(x, y)) / 255.0;
      sand += 1.0;
      sum += brightness;
      squares += brightness * brightness;
    }
  }
  const double deviation = std::sqrt(std::max(squares / sand - sum / sand * sum / sand, 0.0));
  std::cout << file << ": " << 100.0 * shareOfSand(picture)
            << " % of the picture is sand, its brightness varies by " << deviation << "\n";
  EXPECT_GT(deviation, 0.02);
}

INSTANTIATE_TEST_SUITE_P(OfScenes, ScenePictures,
                         testing::Values(ScenePicture{"blade", 4.0, 0.25}, ScenePicture{"bucket", 3.5, 0.01},
                                         ScenePicture{"mixing", 2.6, 0.2}, ScenePicture{"terrain", 3.0, 0.1},
                                         ScenePicture{"writing", 4.0, 0.25}),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace shallow_sand

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_scene_pictures", ros::init_options::NoSigintHandler);
  shallow_sand::RvizWindow rviz(argc, argv, shallow_sand::kConfig + "sand.rviz");
  shallow_sand::window = &rviz;
  return RUN_ALL_TESTS();
}
