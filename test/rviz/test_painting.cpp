#include <OGRE/OgreCamera.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <rviz/render_panel.h>
#include <rviz/tool.h>
#include <rviz/tool_manager.h>
#include <rviz/visualization_manager.h>

#include <QCoreApplication>
#include <QMouseEvent>
#include <QProcess>
#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "random_seed.h"
#include "rviz/rviz_window.h"
#include "shallow_sand/Status.h"
#include "shallow_sand/client/height_field_subscriber.h"
#include "shallow_sand/rviz/painting_stick.h"
#include "shallow_sand/rviz/sand_vertices.h"

namespace shallow_sand {
namespace {

RvizWindow* window = nullptr;

// Of the tool, in config/scenes/writing.rviz.
constexpr float kRadius = 0.05f;
constexpr float kDepth = 0.02f;
constexpr float kSpeed = 2.0f;

/// How far sand slides that is as fast as the stick: v^2 / 2 mu g. [m]
const float kSlide = kSpeed * kSpeed / (2.0f * std::tan(30.0f * static_cast<float>(M_PI) / 180.0f) * 9.81f);

struct Stroke {
  Ogre::Vector2 from;
  Ogre::Vector2 to;

  float length() const { return from.distance(to); }
  Ogre::Vector2 at(float share) const { return from + share * (to - from); }
  float distance(const Ogre::Vector2& place) const {
    const Ogre::Vector2 way = to - from;
    const float share = (place - from).dotProduct(way) / way.squaredLength();
    return place.distance(at(std::clamp(share, 0.0f, 1.0f)));
  }
};

class Painting : public testing::Test {
 protected:
  void SetUp() override {
    QObject::connect(&window->manager(), &rviz::VisualizationManager::statusUpdate, &receiver_,
                     [this](const QString& message) { words_ = message.toStdString(); });
    ASSERT_TRUE(window->runUntil([&] { return !map_.depth.empty() && status_; }, 30.0));
    ASSERT_TRUE(window->runUntil([&] { return window->sand()->field() != nullptr; }, 30.0));
    ASSERT_TRUE(window->runFrames(3, 20.0));
  }

  static void choose(const char* tool_class) {
    rviz::ToolManager& tools = *window->manager().getToolManager();
    for (int k = 0; k < tools.numTools(); ++k) {
      if (tools.getTool(k)->getClassId() == tool_class) tools.setCurrentTool(tools.getTool(k));
    }
    ASSERT_EQ(tools.getCurrentTool()->getClassId(), tool_class);
  }

  QPoint pixelOf(const Ogre::Vector2& place) const {
    rviz::RenderPanel& panel = *window->manager().getRenderPanel();
    const Ogre::Camera& camera = *panel.getCamera();
    // The sand's frame is the fixed frame here, and the sand is level.
    const Ogre::Vector3 seen =
        camera.getProjectionMatrix() *
        (camera.getViewMatrix() * Ogre::Vector3(place.x, place.y, groundElevation(start_, 0)));
    return {static_cast<int>((0.5f + 0.5f * seen.x) * static_cast<float>(panel.width())),
            static_cast<int>((0.5f - 0.5f * seen.y) * static_cast<float>(panel.height()))};
  }

  void mouse(QEvent::Type type, const QPoint& pixel) const {
    const bool is_move = type == QEvent::MouseMove;
    const bool is_held = type != QEvent::MouseButtonRelease;
    QMouseEvent event(type, pixel, is_move ? Qt::NoButton : Qt::LeftButton,
                      is_held ? Qt::LeftButton : Qt::NoButton, Qt::NoModifier);
    QCoreApplication::sendEvent(window->manager().getRenderPanel(), &event);
  }
  void press(const Ogre::Vector2& place) const { mouse(QEvent::MouseButtonPress, pixelOf(place)); }
  void drag(const Ogre::Vector2& place) const { mouse(QEvent::MouseMove, pixelOf(place)); }
  void release(const Ogre::Vector2& place) const { mouse(QEvent::MouseButtonRelease, pixelOf(place)); }

  Ogre::Vector2 centreOf(std::size_t cell) const {
    return {(static_cast<float>(cell % map_.columns) + 0.5f) * map_.spacing,
            (static_cast<float>(cell / map_.columns) + 0.5f) * map_.spacing};
  }
  float drop(std::size_t cell) const { return groundElevation(start_, cell) - groundElevation(map_, cell); }
  /// Drops of cells that a predicate of their centre takes, in order.
  template <class Wanted>
  std::vector<float> drops(const Wanted& wanted) const {
    std::vector<float> all;
    for (std::size_t cell = 0; cell < map_.depth.size(); ++cell)
      if (wanted(centreOf(cell))) all.push_back(drop(cell));
    std::sort(all.begin(), all.end());
    return all;
  }
  /// Along its middle, and not at the ends: the walls slide in.
  std::vector<float> dropsAlong(const Stroke& stroke) const {
    const float end = 2.0f * kRadius / stroke.length();
    const Stroke middle{stroke.at(end), stroke.at(1.0f - end)};
    return drops([&](const Ogre::Vector2& place) { return middle.distance(place) < 0.25f * kRadius; });
  }
  ::testing::AssertionResult isDrawn(const Stroke& stroke) const {
    const bool drawn =
        window->runUntil([&] { return dropsAlong(stroke).front() > kDepth - map_.spacing; }, 20.0);
    const std::vector<float> along = dropsAlong(stroke);
    std::cout << "lower by " << along.front() << " to " << along.back() << " m, in the middle by "
              << along[along.size() / 2] << " m\n";
    return drawn ? ::testing::AssertionSuccess()
                 : ::testing::AssertionFailure()
                       << "it is interrupted; the sand left out " << status_->time_given_up << " s";
  }
  /// The stick, as the node knows it; null if it does not.
  const BodyStatus* stick() const {
    for (const BodyStatus& body : status_->bodies)
      if (body.name.find("painting_stick") == 0) return &body;
    return nullptr;
  }

  HeightField start_;
  HeightField map_;
  Status::ConstPtr status_;
  std::string words_;  // in rviz' status bar

 private:
  ros::NodeHandle node_;
  QObject receiver_;
  HeightFieldSubscriber maps_{node_, "/sand_node/height_field",
                              [this](const HeightField& field, const HeightFieldMap::Change&) {
                                if (start_.depth.empty()) start_ = field;
                                map_ = field;
                              }};
  ros::Subscriber statuses_ = node_.subscribe<Status>(
      "/sand_node/status", 1, [this](const Status::ConstPtr& message) { status_ = message; });
};

TEST_F(Painting, AStickGoesWhereTheMouseGoes) {
  std::mt19937 generator = seededGenerator();
  const auto between = [&](float low, float high) {
    return std::uniform_real_distribution<float>(low, high)(generator);
  };
  // From the left to the right, with room for what slides.
  const auto stroke = [&](float low, float high) {
    return Stroke{{between(0.8f, 1.4f), between(low, high)}, {between(3.4f, 4.4f), between(low, high)}};
  };
  choose("shallow_sand/PaintSand");

  const Stroke drawn = stroke(1.8f, 2.1f);
  press(drawn.from);
  // A hand that hesitates digs no deeper.
  for (int k = 0; k < 8; ++k) {
    drag(drawn.from + Ogre::Vector2(k % 2 == 0 ? 0.01f : 0.0f, 0.0f));
    window->runFrames(1, 5.0);
  }
  for (int k = 1; k <= 8; ++k) {
    drag(drawn.at(static_cast<float>(k) / 8.0f));
    window->runFrames(1, 5.0);
  }
  window->picture().save(PICTURES "painting.png");
  release(drawn.to);
  EXPECT_TRUE(isDrawn(drawn));

  // The mouse is nowhere between, and away before the stick has come.
  const Stroke flick = stroke(0.5f, 0.8f);
  const ros::Time begin = ros::Time::now();
  press(flick.from);
  drag(flick.to);
  release(flick.to);
  EXPECT_TRUE(isDrawn(flick));
  EXPECT_GT((ros::Time::now() - begin).toSec(), 0.9 * static_cast<double>(flick.length() / kSpeed));

  ASSERT_TRUE(window->runUntil([&] { return stick() != nullptr && status_->max_speed == 0.0; }, 20.0));
  EXPECT_EQ(stick()->jumps, 0u);
  EXPECT_EQ(stick()->state, BodyStatus::MOVING) << stick()->problem;
  window->picture().save(PICTURES "painted.png");
  for (const Stroke& one : {drawn, flick}) {
    const std::vector<float> along = dropsAlong(one);
    EXPECT_NEAR(along[along.size() / 2], kDepth, 0.1f * kDepth);
    EXPECT_GT(along.front(), kDepth - map_.spacing);
    EXPECT_LT(along.back(), kDepth + map_.spacing / 2.0f);
  }
  const std::vector<float> elsewhere = drops([&](const Ogre::Vector2& place) {
    return std::min(drawn.distance(place), flick.distance(place)) > 2.0f * kRadius + kSlide;
  });
  EXPECT_EQ(elsewhere.front(), 0.0f);
  EXPECT_EQ(elsewhere.back(), 0.0f);

  choose("rviz/MoveCamera");
  EXPECT_TRUE(window->runUntil([&] { return stick() == nullptr; }, 10.0)) << "the stick stays";
  EXPECT_LT(status_->volume_error, 1e-6);
  EXPECT_EQ(window->errors(), "");
}

/// As one that died between its answer and its first look at a pose.
TEST_F(Painting, ANodeThatNeverFollowsAStickHasLostIt) {
  ros::NodeHandle node;
  const boost::function<bool(AddBody::Request&, AddBody::Response&)> takes = [](auto&, auto& response) {
    response.success = 1;
    return true;
  };
  const ros::ServiceServer add_body = node.advertiseService("deaf/add_body", takes);
  PaintingStick stick(node, "/deaf", "sand", {0.05, 0.3}, Ogre::Vector3::ZERO);
  EXPECT_FALSE(stick.isLost());
  ASSERT_TRUE(window->runUntil([&] { return stick.news().has_value(); }, 10.0));
  EXPECT_FALSE(stick.isLost());
  EXPECT_TRUE(window->runUntil([&] { return stick.isLost(); }, 10.0));
}

/// The last test: nobody starts the node again.
TEST_F(Painting, ANodeThatIsGoneIsTold) {
  choose("shallow_sand/PaintSand");
  press({2.0f, 1.3f});
  release({2.0f, 1.3f});
  ASSERT_TRUE(window->runUntil([&] { return stick() != nullptr; }, 10.0));
  ASSERT_EQ(QProcess::execute("rosnode", {"kill", "/sand_node"}), 0);
  const auto tellsIt = [&] {
    press({2.5f, 1.3f});
    release({2.5f, 1.3f});
    return window->runUntil([&] { return words_ == "/sand_node/add_body does not answer"; }, 0.5);
  };
  EXPECT_TRUE(window->runUntil(tellsIt, 20.0)) << words_;
  choose("rviz/MoveCamera");
}

}  // namespace
}  // namespace shallow_sand

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_painting", ros::init_options::NoSigintHandler);
  shallow_sand::RvizWindow rviz(argc, argv, SHALLOW_SAND_SOURCE_DIR "/config/scenes/writing.rviz");
  shallow_sand::window = &rviz;
  return RUN_ALL_TESTS();
}
