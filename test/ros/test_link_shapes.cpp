#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include "shallow_sand/ros/link_shapes.h"
#include "shallow_sand/scene/scene.h"

namespace shallow_sand {
namespace {

LinkShapes read(const std::string& yaml) { return readLinkShapes(YAML::Load(yaml), "test"); }

std::string refusal(const std::string& yaml) {
  try {
    read(yaml);
  } catch (const SceneError& error) {
    return error.what();
  }
  return "";
}

TEST(LinkShapes, NothingSaidIsExact) { EXPECT_EQ(shapeOf(read("{}"), "bucket"), LinkShape::exact); }

TEST(LinkShapes, TheLongestPatternDecides) {
  const LinkShapes shapes =
      read("{'*': convex_hull, 'wheel_*': bounding_box, wheel_front: exact, base: bounding_box}");
  EXPECT_EQ(shapeOf(shapes, "arm"), LinkShape::convex_hull);
  EXPECT_EQ(shapeOf(shapes, "wheel_rear"), LinkShape::bounding_box);
  EXPECT_EQ(shapeOf(shapes, "wheel_front"), LinkShape::exact);
  EXPECT_EQ(shapeOf(shapes, "base"), LinkShape::bounding_box);
}

TEST(LinkShapes, PatternsWithoutALinkAreFound) {
  const LinkShapes shapes = read("{'wheel_*': convex_hull, 'track_?': convex_hull, arm: exact}");
  const std::vector<std::string> expected{"track_?"};
  EXPECT_EQ(unmatchedPatterns(shapes, {"wheel_1", "arm"}), expected);
}

TEST(LinkShapes, ErrorsNameTheKey) {
  const std::string wrong_name = refusal("{bucket: sphere}");
  EXPECT_NE(wrong_name.find("test: shapes.bucket: sphere"), std::string::npos) << wrong_name;
  EXPECT_NE(wrong_name.find("convex_hull"), std::string::npos) << wrong_name;
  const std::string no_name = refusal("{bucket: [exact]}");
  EXPECT_NE(no_name.find("shapes.bucket: "), std::string::npos) << no_name;
  const std::string no_map = refusal("[convex_hull]");
  EXPECT_NE(no_map.find("test: shapes: "), std::string::npos) << no_map;
}

}  // namespace
}  // namespace shallow_sand
