#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "changing_sand.h"
#include "random_seed.h"
#include "shallow_sand/client/height_field_map.h"
#include "shallow_sand/ros/height_field_difference.h"

namespace shallow_sand {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

struct Sent {
  HeightField map;
  HeightFieldUpdate update;
};

/// A map with loads, and an update of it.
Sent send(std::mt19937& random) {
  ChangingSand sand(random, 40);
  sand.fields.addLoads();
  HeightFieldDifference node(sand.grid, "sand", sand.constants, true);
  node.take(sand.whole(), ros::Time(1.0));
  Sent sent{node.map(), {}};
  sand.fields.depth[random() % sand.grid.cells()] += 1.0f;
  sent.update = node.take(sand.whole(), ros::Time(2.0)).updates.at(0);
  return sent;
}

TEST(HeightFieldMap, RefusesMapsThatAreNone) {
  std::mt19937 random = seededGenerator();
  const Sent sent = send(random);
  const std::vector<std::pair<std::string, std::function<void(HeightField&)>>> broken = {
      {"grid", [](HeightField& map) { map.columns = 0; }},
      {"bed", [](HeightField& map) { map.columns = map.rows = std::numeric_limits<std::uint32_t>::max(); }},
      {"grid", [](HeightField& map) { map.spacing = 0.0f; }},
      {"grid", [](HeightField& map) { map.spacing = kNan; }},
      {"grid", [](HeightField& map) { map.origin_y = static_cast<double>(kNan); }},
      {"bed", [](HeightField& map) { map.bed.clear(); }},
      {"bed", [](HeightField& map) { map.bed[0] = kNan; }},
      {"depth", [](HeightField& map) { map.depth.pop_back(); }},
      {"depth", [](HeightField& map) { map.depth.back() = std::numeric_limits<float>::infinity(); }},
      {"speed", [](HeightField& map) { map.speed.push_back(0.0f); }},
      {"load ", [](HeightField& map) { map.load.push_back(0.0f); }},
      {"load_elevation", [](HeightField& map) { map.load_elevation.clear(); }},
  };
  HeightFieldMap follower;
  ASSERT_EQ(follower.take(sent.map).refused, "");
  for (const auto& [word, breaks] : broken) {
    HeightField map = sent.map;
    map.map += 1;
    breaks(map);
    const HeightFieldMap::Change change = follower.take(map);
    EXPECT_NE(change.refused.find(word), std::string::npos) << change.refused;
    EXPECT_NE(change.refused.find("expected"), std::string::npos);
    EXPECT_FALSE(change.made_anew);
    EXPECT_EQ(follower.field()->map, sent.map.map);
  }
}

TEST(HeightFieldMap, RefusesUpdatesThatAreNone) {
  std::mt19937 random = seededGenerator();
  const Sent sent = send(random);
  const std::uint32_t far = std::numeric_limits<std::uint32_t>::max();
  const std::vector<std::pair<std::string, std::function<void(HeightFieldUpdate&)>>> broken = {
      {"depth", [](HeightFieldUpdate& update) { update.depth.pop_back(); }},
      {"depth", [=](HeightFieldUpdate& update) { update.columns = update.rows = far; }},
      {"depth", [](HeightFieldUpdate& update) { update.depth[0] = kNan; }},
      {"speed", [](HeightFieldUpdate& update) { update.speed.push_back(0.0f); }},
      {"load ", [](HeightFieldUpdate& update) { update.load[0] = -std::numeric_limits<float>::infinity(); }},
      {"load_elevation", [](HeightFieldUpdate& update) { update.load_elevation.clear(); }},
      {"outside", [=](HeightFieldUpdate& update) { update.column = far; }},
      {"outside", [&](HeightFieldUpdate& update) { update.row = sent.map.rows; }},
  };
  for (const auto& [word, breaks] : broken) {
    HeightFieldMap follower;
    follower.take(sent.map);
    HeightFieldUpdate update = sent.update;
    breaks(update);
    const HeightFieldMap::Change change = follower.take(update);
    EXPECT_NE(change.refused.find(word), std::string::npos) << change.refused;
    EXPECT_NE(change.refused.find("expected"), std::string::npos);
    EXPECT_TRUE(change.cells.empty());
    EXPECT_TRUE(sameBits(follower.field()->depth, sent.map.depth));
  }
}

TEST(HeightFieldMap, UpdatesBeforeTheMapAreKeptAndOldOnesAreNot) {
  std::mt19937 random = seededGenerator();
  const Sent sent = send(random);
  HeightFieldMap follower;
  follower.take(sent.update);
  EXPECT_TRUE(follower.needsMap());
  EXPECT_EQ(follower.field(), nullptr);
  EXPECT_TRUE(follower.take(sent.map).made_anew);
  EXPECT_FALSE(follower.needsMap());
  EXPECT_EQ(follower.field()->sequence, sent.update.sequence);
  const HeightFieldMap::Change again = follower.take(sent.update);
  EXPECT_TRUE(again.cells.empty() && again.refused.empty());
  EXPECT_FALSE(follower.needsMap());
}

TEST(HeightFieldMap, FollowsARecordingThatBeginsAnew) {
  std::mt19937 random = seededGenerator();
  const Sent sent = send(random);
  HeightFieldMap follower;
  follower.take(sent.map);
  for (int pass = 0; pass < 3; ++pass) {
    follower.take(sent.map);
    follower.take(sent.update);
    EXPECT_EQ(follower.field()->sequence, sent.update.sequence);
    EXPECT_FALSE(follower.needsMap());
  }
  HeightFieldUpdate lost = sent.update;
  follower.take(sent.map);
  lost.depth.pop_back();
  EXPECT_NE(follower.take(lost).refused, "");
  EXPECT_TRUE(follower.needsMap());
}

TEST(HeightFieldMap, AMapThatIsAskedForChangesOnlyWhatWasMissed) {
  std::mt19937 random = seededGenerator();
  const Sent sent = send(random);
  HeightFieldMap follower;
  follower.take(sent.map);
  HeightField healed = sent.map;
  healed.sequence += 5;
  const std::size_t cell = random() % healed.depth.size();
  healed.depth[cell] += 1.0f;
  const HeightFieldMap::Change change = follower.take(healed);
  EXPECT_FALSE(change.made_anew);
  ASSERT_EQ(change.cells.size(), 1u);
  EXPECT_EQ(std::size_t{change.cells[0].row} * healed.columns + change.cells[0].column, cell);
  EXPECT_EQ(change.cells[0].columns * change.cells[0].rows, 1u);
  EXPECT_EQ(follower.field()->depth, healed.depth);
}

/// An update of so many cells takes its place in the memory of who waits for a map.
TEST(HeightFieldMap, LargeUpdatesAreNotKeptWithoutEnd) {
  constexpr std::uint32_t kSide = 2048;
  HeightFieldUpdate update;
  update.map = 1;
  update.columns = update.rows = kSide;
  update.depth.assign(std::size_t{kSide} * kSide, 0.5f);
  HeightFieldMap follower;
  for (update.sequence = 1; update.sequence <= 17; ++update.sequence) follower.take(update);
  HeightField map;
  map.map = 1;
  map.columns = map.rows = kSide;
  map.spacing = 0.1f;
  map.bed = map.depth = update.depth;
  // The first was dropped when the last came.
  follower.take(map);
  EXPECT_EQ(follower.field()->sequence, 0u);
  EXPECT_TRUE(follower.needsMap());
  map.sequence = 1;
  follower.take(map);
  EXPECT_EQ(follower.field()->sequence, 17u);
  EXPECT_FALSE(follower.needsMap());
}

}  // namespace
}  // namespace shallow_sand
