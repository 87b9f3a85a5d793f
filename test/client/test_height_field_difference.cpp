#include <gtest/gtest.h>
#include <ros/serialization.h>

#include <deque>
#include <iostream>

#include "changing_sand.h"
#include "random_seed.h"
#include "shallow_sand/client/height_field_map.h"
#include "shallow_sand/ros/height_field_difference.h"
#include "shallow_sand/scene/simulation.h"

namespace shallow_sand {
namespace {

Window cellsOf(const HeightFieldUpdate& update) {
  const int column = static_cast<int>(update.column);
  const int row = static_cast<int>(update.row);
  return {column, row, column + static_cast<int>(update.columns), row + static_cast<int>(update.rows)};
}

/// Cells in which two maps differ in any bit.
std::vector<bool> differences(const HeightField& a, const HeightField& b) {
  std::vector<bool> differ(a.depth.size());
  for (const auto member :
       {&HeightField::depth, &HeightField::speed, &HeightField::load, &HeightField::load_elevation}) {
    // Loads may have come.
    if ((a.*member).size() != (b.*member).size()) continue;
    for (std::size_t k = 0; k < (a.*member).size(); ++k)
      if (std::memcmp(&(a.*member)[k], &(b.*member)[k], sizeof(float)) != 0) differ[k] = true;
  }
  return differ;
}

TEST(HeightFieldDifference, RectanglesHoldAllThatChangedAndEndWithIt) {
  std::mt19937 random = seededGenerator();
  for (int run = 0; run < 20; ++run) {
    ChangingSand sand(random, 200);
    HeightFieldDifference difference(sand.grid, "sand", sand.constants, random() % 2 == 0);
    EXPECT_TRUE(difference.take(sand.whole(), ros::Time(1.0)).map_is_new);
    for (int frame = 0; frame < 10; ++frame) {
      const HeightField before = difference.map();
      const auto updates = difference.take(sand.change(random), ros::Time(2.0 + frame)).updates;
      const HeightField& now = difference.map();
      const std::vector<bool> differ = differences(before, now);
      const bool loads_came = before.load.size() != now.load.size();
      std::vector<bool> sent(differ.size());
      for (const HeightFieldUpdate& update : updates) {
        const Window cells = cellsOf(update);
        int sides = 0;  // bits: which sides hold a cell that has changed
        for (int j = cells.row_begin; j < cells.row_end; ++j) {
          for (int i = cells.column_begin; i < cells.column_end; ++i) {
            const std::size_t k = sand.grid.index(i, j);
            ASSERT_FALSE(sent[k]) << "a cell is sent twice";
            sent[k] = true;
            if (!differ[k] && !(loads_came && k == 0)) continue;
            sides |= (i == cells.column_begin ? 1 : 0) | (i == cells.column_end - 1 ? 2 : 0) |
                     (j == cells.row_begin ? 4 : 0) | (j == cells.row_end - 1 ? 8 : 0);
          }
        }
        EXPECT_EQ(sides, 15) << "a rectangle is larger than what has changed";
      }
      for (std::size_t k = 0; k < differ.size(); ++k)
        ASSERT_TRUE(!differ[k] || sent[k]) << "a change is not sent";
      // All is known now: the same again is nothing.
      EXPECT_TRUE(difference.take(sand.whole(), ros::Time(3.0 + frame)).updates.empty());
    }
  }
}

TEST(HeightFieldDifference, ManySmallChangesAreFewMessages) {
  std::mt19937 random = seededGenerator();
  ChangingSand sand(random, 1);
  sand.grid.columns = 1500;
  sand.grid.rows = 1200;
  sand.fields = {};
  for (std::vector<float>* values :
       {&sand.fields.bed, &sand.fields.depth, &sand.fields.momentum_x, &sand.fields.momentum_y})
    values->resize(sand.grid.cells(), 1.0f);
  HeightFieldDifference difference(sand.grid, "sand", sand.constants, true);
  difference.take(sand.whole(), ros::Time(1.0));
  for (int k = 0; k < 5000; ++k) sand.changeCell(random, random() % sand.grid.cells());
  const auto updates = difference.take(sand.whole(), ros::Time(2.0)).updates;
  EXPECT_LE(updates.size(), 256u);
  HeightFieldMap client;
  client.take(difference.map());
  expectIs(*client.field(), sand, true);
}

/// A node and the way from it to a follower, on which messages of the two topics pass each other and updates
/// are lost; but as queues lose them, which let the last one through.
struct LossyWay {
  std::deque<HeightField> maps;
  std::deque<HeightFieldUpdate> updates;
  HeightFieldMap follower;
  bool joined = false;

  void ask(const HeightFieldDifference& node) { maps.push_back(node.map()); }
  void join(const HeightFieldDifference& node) {
    *this = LossyWay();
    joined = true;
    ask(node);
    updates.push_back(node.sequence());
  }
  void send(std::mt19937& random, const std::vector<HeightFieldUpdate>& news) {
    for (const HeightFieldUpdate& update : news) {
      if (!updates.empty() && random() % 3 == 0) updates.pop_back();
      updates.push_back(update);
    }
  }
  void deliver(std::mt19937& random, int messages) {
    for (; messages > 0 && !(maps.empty() && updates.empty()); --messages) {
      if (updates.empty() || (!maps.empty() && random() % 2 == 0)) {
        EXPECT_EQ(follower.take(maps.front()).refused, "");
        maps.pop_front();
      } else {
        EXPECT_EQ(follower.take(updates.front()).refused, "");
        updates.pop_front();
      }
    }
  }
};

TEST(HeightFieldDifference, FollowersWhoJoinLateLoseUpdatesAndRestartHaveTheSameBits) {
  std::mt19937 random = seededGenerator();
  for (int run = 0; run < 30; ++run) {
    SCOPED_TRACE(run);
    ChangingSand sand(random, 120);
    const bool with_speed = random() % 2 == 0;
    auto node = std::make_unique<HeightFieldDifference>(sand.grid, "sand", sand.constants, with_speed);
    std::vector<LossyWay> ways(4);
    const auto take = [&](const FieldsChange& change) {
      const auto news = node->take(change, ros::Time(1.0));
      for (LossyWay& way : ways) {
        if (news.map_is_new && way.joined) way.ask(*node);
        if (way.joined) way.send(random, news.updates);
      }
    };
    take(sand.whole());
    for (int frame = 0; frame < 40; ++frame) {
      if (random() % 20 == 0) {
        // The node starts anew, perhaps with another grid; its topics are the same.
        if (random() % 2 == 0) sand = ChangingSand(random, 120);
        node = std::make_unique<HeightFieldDifference>(sand.grid, "sand", sand.constants, with_speed);
        take(sand.whole());
      }
      if (random() % 20 == 0) {
        sand.fields.bed[0] += 1.0f;
        take(sand.whole());
      }
      take(sand.change(random));
      for (LossyWay& way : ways) {
        if (random() % 10 == 0) way.join(*node);
        way.deliver(random, randomCount(random, 0, 12));
        if (way.follower.needsMap() && way.maps.empty() && random() % 2 == 0) way.ask(*node);
      }
    }
    // The sand rests from here on: no message follows but those that are on their way, and maps that were
    // asked for.
    for (LossyWay& way : ways) {
      if (!way.joined) way.join(*node);
      way.deliver(random, 1000000);
      if (way.follower.needsMap()) way.ask(*node);
      way.deliver(random, 1000000);
      EXPECT_FALSE(way.follower.needsMap());
      ASSERT_NE(way.follower.field(), nullptr);
      expectIs(*way.follower.field(), sand, with_speed);
      EXPECT_EQ(way.follower.field()->map, node->map().map);
      EXPECT_EQ(way.follower.field()->sequence, node->map().sequence);
    }
    if (HasFailure()) return;
  }
}

TEST(HeightFieldDifference, AMovingBladeTakesAFewBytesOfAMillionCells) {
  Scene scene = loadScene(std::string(SHALLOW_SAND_SOURCE_DIR) + "/config/scenes/blade.yaml");
  GridParameters& grid = scene.parameters.grid;
  grid.size = Eigen::Vector2d(1024, 1024) * grid.spacing;
  scene.parameters.backend = Backend::cpu;
  scene.bed.assign(grid.grid().cells(), 0.0f);
  scene.depth.assign(grid.grid().cells(), 0.3f);
  Simulator simulator = buildSimulator(scene);
  HeightFieldDifference difference(
      simulator.grid(), "sand",
      sandConstants(simulator.grid(), scene.parameters.gravity, scene.parameters.material), true);
  HeightFieldMap follower;
  double sent = 0.0;
  double whole = 0.0;
  std::size_t messages = 0;
  constexpr int kFrames = 30;
  for (int frame = 0; frame <= kFrames; ++frame) {
    simulator.advanceTo(0.1 * frame);
    simulator.requestFields();
    const Fields& fields = simulator.collectFields();
    const auto news = difference.take(changeOf(fields, simulator.takeChanges(), simulator.grid()),
                                      ros::Time(1.0 + 0.1 * frame));
    EXPECT_EQ(news.map_is_new, frame == 0);
    if (frame == 0) {
      follower.take(difference.map());
      continue;
    }
    whole += ros::serialization::serializationLength(difference.map());
    messages += news.updates.size();
    for (const HeightFieldUpdate& update : news.updates) {
      sent += ros::serialization::serializationLength(update);
      follower.take(update);
    }
    ASSERT_TRUE(sameBits(follower.field()->depth, fields.depth));
    ASSERT_TRUE(sameBits(follower.field()->load, fields.load));
  }
  const double first = ros::serialization::serializationLength(difference.map());
  std::cout << "a blade on 1024 x 1024 cells, 10 Hz: " << sent / kFrames << " bytes an update in "
            << static_cast<double>(messages) / kFrames << " messages; whole map " << first << " bytes; "
            << 100.0 * sent / whole << " % of whole maps, " << 100.0 * (sent + first) / whole
            << " % with the first map of " << 0.1 * kFrames << " s" << std::endl;
  EXPECT_GT(sent, 0.0);
  EXPECT_LE(sent, 0.05 * whole);
}

}  // namespace
}  // namespace shallow_sand
