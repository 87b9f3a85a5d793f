#include <OGRE/OgreCamera.h>
#include <OGRE/OgreViewport.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <rviz/properties/property.h>
#include <rviz/render_panel.h>
#include <rviz/visualization_manager.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "rviz/rviz_window.h"
#include "rviz/sand_colors.h"
#include "shallow_sand/client/height_field_subscriber.h"
#include "shallow_sand/rviz/sand_vertices.h"

namespace shallow_sand {
namespace {

RvizWindow* window = nullptr;

/// Where a cell's surface is in the picture, in pixels; nothing if something else may hide it.
class Projection {
 public:
  Projection(const HeightField& map, const QImage& picture)
      : map_(map), picture_(picture), camera_(*window->manager().getRenderPanel()->getCamera()) {}

  std::optional<QPoint> pixelOf(std::size_t cell) const {
    const auto i = static_cast<float>(cell % map_.columns);
    const auto j = static_cast<float>(cell / map_.columns);
    const Ogre::Vector3 place(static_cast<float>(map_.origin_x) + (i + 0.5f) * map_.spacing,
                              static_cast<float>(map_.origin_y) + (j + 0.5f) * map_.spacing,
                              groundElevation(map_, cell));
    const std::optional<SandPlace> first = window->sand()->meet(
        Ogre::Ray(camera_.getDerivedPosition(), (place - camera_.getDerivedPosition()).normalisedCopy()));
    if (!first || first->in_map.distance(place) > 2.0f * map_.spacing) return std::nullopt;
    return pixelOf(place);
  }

  /// Of the cut through the sand where x is largest, half way down; none if it is seen from behind.
  std::vector<QPoint> pixelsOfCut() const {
    std::vector<QPoint> pixels;
    // The cut stands where the middles of the outermost cells are.
    const float x =
        static_cast<float>(map_.origin_x) + (static_cast<float>(map_.columns) - 0.5f) * map_.spacing;
    if (camera_.getDerivedPosition().x < x) return pixels;
    for (std::uint32_t j = 0; j < map_.rows; ++j) {
      const std::size_t cell = static_cast<std::size_t>(j + 1) * map_.columns - 1;
      const float y = static_cast<float>(map_.origin_y) + (static_cast<float>(j) + 0.5f) * map_.spacing;
      const float z = groundElevation(map_, cell) - 0.5f * map_.depth[cell];
      if (const auto pixel = pixelOf({x, y, z})) pixels.push_back(*pixel);
    }
    return pixels;
  }

 private:
  /// The sand's frame is the fixed frame here.
  std::optional<QPoint> pixelOf(const Ogre::Vector3& place) const {
    const Ogre::Vector3 seen = camera_.getProjectionMatrix() * (camera_.getViewMatrix() * place);
    const QPoint pixel(static_cast<int>((0.5f + 0.5f * seen.x) * static_cast<float>(picture_.width())),
                       static_cast<int>((0.5f - 0.5f * seen.y) * static_cast<float>(picture_.height())));
    if (!picture_.rect().contains(pixel)) return std::nullopt;
    return pixel;
  }

  const HeightField& map_;
  const QImage& picture_;
  const Ogre::Camera& camera_;
};

/// Pixels that show cells on which `wanted` holds.
template <class Wanted>
std::vector<QPoint> pixelsOf(const HeightField& map, const QImage& picture, const Wanted& wanted) {
  const Projection projection(map, picture);
  std::vector<QPoint> pixels;
  for (std::size_t cell = 0; cell < map.depth.size(); ++cell) {
    if (!wanted(cell)) continue;
    if (const std::optional<QPoint> pixel = projection.pixelOf(cell)) pixels.push_back(*pixel);
  }
  return pixels;
}

double shareOf(const std::vector<QPoint>& pixels, const std::function<bool(const QPoint&)>& has) {
  return static_cast<double>(std::count_if(pixels.begin(), pixels.end(), has)) /
         static_cast<double>(pixels.size());
}

TEST(Display, ShowsWhereTheRobotDigs) {
  HeightFieldDisplay* display = window->sand();
  ASSERT_NE(display, nullptr);
  // A copy of its own: what the display should show.
  HeightField map;
  ros::NodeHandle node;
  const HeightFieldSubscriber subscriber(
      node, "/sand_node/height_field",
      [&](const HeightField& field, const HeightFieldMap::Change&) { map = field; });
  ASSERT_TRUE(window->runUntil([&] { return !display->mapFrame().empty() && !map.depth.empty(); }, 30.0));
  ASSERT_TRUE(window->runFrames(5, 20.0));
  const HeightField start = map;
  const QImage before = window->picture();
  before.save(PICTURES "excavation_before.png");

  const auto rise = [&](std::size_t cell) {
    return groundElevation(map, cell) - groundElevation(start, cell);
  };
  const auto isDug = [&](std::size_t cell) { return std::abs(rise(cell)) > 0.05f; };
  const auto dugCells = [&] {
    std::size_t dug = 0;
    for (std::size_t cell = 0; cell < map.depth.size(); ++cell) dug += isDug(cell) ? 1 : 0;
    return dug;
  };
  ASSERT_TRUE(window->runUntil([&] { return dugCells() > 600; }, 60.0)) << dugCells() << " cells were dug";
  ASSERT_TRUE(window->runFrames(3, 20.0));
  const QImage after = window->picture();
  after.save(PICTURES "excavation.png");
  EXPECT_EQ(window->errors(), "");

  // The machine hides some of both. What it dug must have changed and yet be sand; what it left alone, not.
  const auto isSandAt = [](const QImage& picture, const QPoint& pixel) {
    return isSand(picture.pixel(pixel));
  };
  const auto differs = [&](const QPoint& pixel) {
    return std::abs(qGray(before.pixel(pixel)) - qGray(after.pixel(pixel))) > 8;
  };
  const auto isSeen = [&](const QPoint& pixel) { return isSandAt(before, pixel) && isSandAt(after, pixel); };
  const auto seen = [&](std::vector<QPoint> pixels) {
    pixels.erase(std::remove_if(pixels.begin(), pixels.end(), [&](const QPoint& p) { return !isSeen(p); }),
                 pixels.end());
    return pixels;
  };
  const std::vector<QPoint> dug = seen(pixelsOf(map, after, isDug));
  const std::vector<QPoint> left =
      seen(pixelsOf(map, after, [&](std::size_t cell) { return rise(cell) == 0.0f; }));
  std::cout << dug.size() << " pixels show what was dug, " << 100.0 * shareOf(dug, differs)
            << " % of them changed; of " << left.size() << " beside it " << 100.0 * shareOf(left, differs)
            << " %\n";
  ASSERT_GT(dug.size(), 200u);
  ASSERT_GT(left.size(), 1000u);
  EXPECT_GT(shareOf(dug, differs), 0.5);
  EXPECT_LT(shareOf(left, differs), 0.1);
}

TEST(Display, ColorsTellWhatIsAskedFor) {
  HeightFieldDisplay* display = window->sand();
  ASSERT_NE(display, nullptr);
  const std::vector<QPoint> cut = Projection(*display->field(), window->picture()).pixelsOfCut();
  ASSERT_GT(cut.size(), 20u);
  for (const char* what : {"Elevation", "Depth", "Slope", "Speed", "Change"}) {
    display->subProp("Color By")->setValue(what);
    ASSERT_TRUE(window->runFrames(4, 20.0));
    const QImage picture = window->picture();
    picture.save(QString(PICTURES "colored_by_%1.png").arg(QString(what).toLower()));
    EXPECT_LT(shareOfSand(picture), 0.3) << what;
    EXPECT_GT(shareOf(cut, [&](const QPoint& pixel) { return isSand(picture.pixel(pixel)); }), 0.98) << what;
  }
  display->subProp("Color By")->setValue("Sand");
  ASSERT_TRUE(window->runFrames(4, 20.0));
  const QImage plain = window->picture();
  EXPECT_GT(shareOfSand(plain), 0.3);

  display->subProp("Contour Interval")->setValue(0.05);
  ASSERT_TRUE(window->runFrames(4, 20.0));
  const QImage contours = window->picture();
  contours.save(PICTURES "contours.png");
  int darker = 0;
  for (int y = 0; y < plain.height(); ++y) {
    for (int x = 0; x < plain.width(); ++x)
      // The machine moves: what is sand in both pictures was not hidden by it.
      darker += isSand(plain.pixel(x, y)) && isSand(contours.pixel(x, y)) &&
                        qGray(contours.pixel(x, y)) < 0.8 * qGray(plain.pixel(x, y))
                    ? 1
                    : 0;
  }
  EXPECT_GT(darker, 300);
  display->subProp("Contour Interval")->setValue(0.0);
  EXPECT_EQ(window->errors(), "");
}

}  // namespace
}  // namespace shallow_sand

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_display", ros::init_options::NoSigintHandler);
  shallow_sand::RvizWindow rviz(argc, argv, SHALLOW_SAND_SOURCE_DIR "/config/excavator/excavation.rviz");
  shallow_sand::window = &rviz;
  return RUN_ALL_TESTS();
}
