#include <gtest/gtest.h>

#include "shallow_sand/bodies/link_selection.h"
#include "shallow_sand/bodies/robot_links.h"

namespace shallow_sand {
namespace {

using Names = std::vector<std::string>;

std::string link(const std::string& name, const std::string& geometry = "<sphere radius='0.1'/>") {
  return "<link name='" + name + "'><collision><geometry>" + geometry + "</geometry></collision></link>";
}

/// A tree of links under `mast`, which has no collision geometry itself.
std::string robot() {
  std::string urdf = "<robot name='rover'><link name='mast'/>";
  for (const std::string name : {"wheel_left", "wheel_right", "arm", "scoop"}) {
    urdf += link(name) + "<joint name='" + name + "_joint' type='fixed'><parent link='mast'/><child link='" +
            name + "'/></joint>";
  }
  return urdf + "</robot>";
}

Names chosen(const LinkPatterns& patterns) {
  Names names;
  for (const LinkGeometry& geometry : collisionGeometry(selectLinks(robot(), patterns).urdf).links) {
    names.push_back(geometry.link);
  }
  return names;  // by name
}

TEST(LinkSelection, takesAllLinksUnlessTold) {
  EXPECT_EQ(chosen({}), (Names{"arm", "scoop", "wheel_left", "wheel_right"}));
  EXPECT_EQ(selectLinks(robot(), {}).available, (Names{"wheel_left", "wheel_right", "arm", "scoop"}));
}

TEST(LinkSelection, includesAndExcludesByShellPatterns) {
  EXPECT_EQ(chosen({{"wheel_*"}, {}}), (Names{"wheel_left", "wheel_right"}));
  EXPECT_EQ(chosen({{"arm", "scoo?"}, {}}), (Names{"arm", "scoop"}));
  EXPECT_EQ(chosen({{}, {"wheel_*", "arm"}}), (Names{"scoop"}));
  EXPECT_EQ(chosen({{"*[mp]", "*_left"}, {"arm"}}), (Names{"scoop", "wheel_left"}));
  EXPECT_EQ(chosen({{"*"}, {"*"}}), Names{});
}

TEST(LinkSelection, tellsPatternsThatMatchNothing) {
  const LinkSelection selection =
      selectLinks(robot(), {{"arm", "track_*"}, {"bucket", "wheel_left", "mast"}});
  EXPECT_EQ(selection.unmatched, (Names{"track_*", "bucket", "mast"}));
}

TEST(LinkSelection, nobodyReadsMeshesOfLinksLeftOut) {
  const std::string urdf =
      "<robot name='r'>" + link("arm", "<mesh filename='file:///no/such/file.stl'/>") + "</robot>";
  EXPECT_EQ(collisionGeometry(selectLinks(urdf, {}).urdf).problems.size(), 1u);
  EXPECT_TRUE(collisionGeometry(selectLinks(urdf, {{}, {"arm"}}).urdf).problems.empty());
}

TEST(LinkSelection, leavesAloneWhatIsNoDescription) {
  for (const std::string text : {"", "<robot name='broken'>", "no XML at all", "<sdf/>"}) {
    const LinkSelection selection = selectLinks(text, {{"arm"}, {}});
    EXPECT_EQ(selection.urdf, text);
    EXPECT_TRUE(selection.available.empty());
  }
}

}  // namespace
}  // namespace shallow_sand
