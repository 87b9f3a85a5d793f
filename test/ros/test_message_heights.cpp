#include <gtest/gtest.h>
#include <sensor_msgs/PointField.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>

#include "random_fields.h"
#include "random_seed.h"
#include "shallow_sand/core/parameters.h"
#include "shallow_sand/ros/message_heights.h"
#include "shallow_sand/surface/cell_heights.h"

namespace shallow_sand {
namespace {

using sensor_msgs::PointCloud2;
using sensor_msgs::PointField;
using visualization_msgs::Marker;

Grid someGrid() {
  Grid grid;
  grid.columns = 8;
  grid.rows = 6;
  grid.spacing = 0.25f;
  return grid;
}

Eigen::Isometry3d randomPose(std::mt19937& random) {
  const Eigen::Vector3d place(uniform(random, -1.0, 1.0), uniform(random, -1.0, 1.0),
                              uniform(random, -1.0, 1.0));
  return Eigen::Translation3d(place) * Eigen::AngleAxisd(uniform(random, -3.0, 3.0), place.normalized());
}

std::vector<Eigen::Vector3f> randomPoints(std::mt19937& random, std::size_t count) {
  std::vector<Eigen::Vector3f> points(count);
  for (Eigen::Vector3f& point : points) {
    for (int k = 0; k < 3; ++k) point[k] = static_cast<float>(uniform(random, -1.0, 3.0));
  }
  return points;
}

/// With coordinates anywhere in a point, in any order, and bytes between points and rows.
PointCloud2 randomCloud(std::mt19937& random, const std::vector<Eigen::Vector3f>& points,
                        std::uint32_t width) {
  PointCloud2 cloud;
  cloud.width = width;
  cloud.height = static_cast<std::uint32_t>(points.size()) / width;
  std::vector<std::string> names{"x", "y", "z", "intensity", "ring"};
  std::shuffle(names.begin(), names.end(), random);
  for (const std::string& name : names) {
    PointField field;
    field.name = name;
    field.offset = cloud.point_step + static_cast<std::uint32_t>(random() % 3);
    field.datatype = name == "ring" ? PointField::UINT16 : PointField::FLOAT32;
    field.count = 1;
    cloud.point_step = field.offset + 4;
    cloud.fields.push_back(field);
  }
  cloud.row_step = width * cloud.point_step + static_cast<std::uint32_t>(random() % 9);
  cloud.data.resize(static_cast<std::size_t>(cloud.row_step) * cloud.height, 0xff);
  for (std::size_t k = 0; k < points.size(); ++k) {
    for (const PointField& field : cloud.fields) {
      const std::size_t axis = std::string("xyz").find(field.name);
      if (axis == std::string::npos) continue;
      const std::size_t at = k / width * cloud.row_step + k % width * cloud.point_step + field.offset;
      std::memcpy(cloud.data.data() + at, &points[k][static_cast<int>(axis)], sizeof(float));
    }
  }
  return cloud;
}

void expectSame(const CellValues& found, const CellValues& expected) {
  EXPECT_EQ(found.given, expected.given);
  EXPECT_TRUE(sameBits(found.values, expected.values));
}

TEST(MessageHeights, OfCloudsAreThoseOfTheirPoints) {
  std::mt19937 random = seededGenerator();
  for (int trial = 0; trial < 50; ++trial) {
    const std::uint32_t width = 1 + random() % 20;
    std::vector<Eigen::Vector3f> points = randomPoints(random, width * (random() % 20));
    const Eigen::Isometry3d pose = randomPose(random);
    MeanHeights expected(someGrid());
    for (Eigen::Vector3f& point : points) {
      if (random() % 10 == 0) point[static_cast<int>(random() % 3)] = std::nanf("");
      if (point.allFinite()) expected.add(pose * point.cast<double>());
    }
    expectSame(heightsOf(randomCloud(random, points, width), pose, someGrid()), expected.values());
  }
}

TEST(MessageHeights, OfMarkersAreThoseOfTheirTriangles) {
  std::mt19937 random = seededGenerator();
  for (int trial = 0; trial < 50; ++trial) {
    const std::vector<Eigen::Vector3f> points = randomPoints(random, 3 * (random() % 20));
    const Eigen::Isometry3d pose = randomPose(random);
    const Eigen::Isometry3d own = randomPose(random);
    Marker marker;
    marker.type = Marker::TRIANGLE_LIST;
    const Eigen::Vector3d scale(2.0, 0.5, uniform(random, -1.0, 1.0));
    marker.scale.x = scale.x();
    marker.scale.y = scale.y();
    marker.scale.z = scale.z();
    marker.pose.position.x = own.translation().x();
    marker.pose.position.y = own.translation().y();
    marker.pose.position.z = own.translation().z();
    const Eigen::Quaterniond rotation(own.linear());
    marker.pose.orientation.x = rotation.x();
    marker.pose.orientation.y = rotation.y();
    marker.pose.orientation.z = rotation.z();
    marker.pose.orientation.w = rotation.w();
    std::vector<Eigen::Vector3d> corners;
    for (const Eigen::Vector3f& point : points) {
      marker.points.emplace_back();
      marker.points.back().x = point.x();
      marker.points.back().y = point.y();
      marker.points.back().z = point.z();
      corners.push_back(pose * (own * scale.cwiseProduct(point.cast<double>())));
    }
    HighestTriangles expected(someGrid());
    for (std::size_t k = 0; k < corners.size(); k += 3)
      expected.add(corners[k], corners[k + 1], corners[k + 2]);
    const CellValues found = heightsOf(marker, pose, someGrid());
    EXPECT_EQ(found.given, expected.values().given);
    for (std::size_t k = 0; k < found.values.size(); ++k)
      EXPECT_NEAR(found.values[k], expected.values().values[k], 1e-4f);
  }
}

void expectRefusal(const PointCloud2& cloud, const std::string& word) {
  try {
    heightsOf(cloud, Eigen::Isometry3d::Identity(), someGrid());
    ADD_FAILURE() << "taken, though " << word << " lies";
  } catch (const InvalidParameter& problem) {
    EXPECT_NE(std::string(problem.what()).find(word), std::string::npos) << problem.what();
  }
}

TEST(MessageHeights, OfCloudsThatLieAreRefused) {
  std::mt19937 random = seededGenerator();
  for (int trial = 0; trial < 50; ++trial) {
    const std::uint32_t width = 2 + random() % 20;
    const PointCloud2 good = randomCloud(random, randomPoints(random, width * (2 + random() % 20)), width);
    EXPECT_NO_THROW(heightsOf(good, Eigen::Isometry3d::Identity(), someGrid()));
    const auto refused = [&](const std::string& word, const std::function<void(PointCloud2&)>& spoil) {
      PointCloud2 cloud = good;
      spoil(cloud);
      expectRefusal(cloud, word);
    };
    constexpr std::uint32_t kHuge = std::numeric_limits<std::uint32_t>::max();
    const std::uint32_t more = 1 + random() % 1000;
    refused("width", [&](PointCloud2& c) { c.width += std::max(more, 9u); });
    refused("width", [&](PointCloud2& c) { c.width = kHuge; });
    refused("height", [&](PointCloud2& c) { c.height += more; });
    refused("height", [&](PointCloud2& c) { c.width = c.height = c.row_step = kHuge; });
    refused("point_step", [&](PointCloud2& c) { c.point_step = 0; });
    refused("point_step", [&](PointCloud2& c) { c.point_step = kHuge; });
    refused("row_step", [&](PointCloud2& c) { c.row_step = random() % c.row_step; });
    refused("data", [&](PointCloud2& c) { c.data.pop_back(); });
    refused("data", [&](PointCloud2& c) { c.data.resize(c.data.size() + more); });
    refused("data", [&](PointCloud2& c) { c.data.clear(); });
    refused("data", [&](PointCloud2& c) { c.height = 0; });
    refused("is_bigendian", [&](PointCloud2& c) { c.is_bigendian = 1; });
    const std::string name(1, "xyz"[random() % 3]);
    const auto spoilField = [&](const std::string& word, const std::function<void(PointField&)>& spoil) {
      refused("fields " + name + ": " + word, [&](PointCloud2& c) {
        for (PointField& field : c.fields) {
          if (field.name == name) spoil(field);
        }
      });
    };
    spoilField("missing", [](PointField& field) { field.name = "other"; });
    spoilField("datatype 8", [](PointField& field) { field.datatype = PointField::FLOAT64; });
    spoilField("datatype 5", [](PointField& field) { field.datatype = PointField::INT32; });
    spoilField("datatype 7, count 2", [](PointField& field) { field.count = 2; });
    spoilField("offset", [&](PointField& field) { field.offset = good.point_step - 3; });
    spoilField("offset", [&](PointField& field) { field.offset = kHuge - random() % 4; });
  }
}

TEST(MessageHeights, OfDenseCloudsWithGapsAreRefused) {
  std::mt19937 random = seededGenerator();
  std::vector<Eigen::Vector3f> points = randomPoints(random, 6);
  points[random() % 6][2] = std::numeric_limits<float>::infinity();
  PointCloud2 cloud = randomCloud(random, points, 3);
  EXPECT_NO_THROW(heightsOf(cloud, Eigen::Isometry3d::Identity(), someGrid()));
  cloud.is_dense = 1;
  expectRefusal(cloud, "is_dense");
}

TEST(MessageHeights, OfOtherMarkersAreRefused) {
  Marker good;
  good.type = Marker::TRIANGLE_LIST;
  good.scale.x = good.scale.y = good.scale.z = 1.0;
  good.points.resize(6);
  EXPECT_NO_THROW(heightsOf(good, Eigen::Isometry3d::Identity(), someGrid()));
  for (const auto& spoil : std::vector<std::function<void(Marker&)>>{
           [](Marker& m) { m.type = Marker::CUBE_LIST; }, [](Marker& m) { m.action = Marker::DELETE; },
           [](Marker& m) { m.points.pop_back(); }, [](Marker& m) { m.points[4].z = std::nan(""); },
           [](Marker& m) { m.points[0].x = std::numeric_limits<double>::infinity(); },
           [](Marker& m) { m.scale.y = std::nan(""); }, [](Marker& m) { m.pose.position.x = std::nan(""); },
           [](Marker& m) { m.pose.orientation.w = 2.0; }}) {
    Marker bad = good;
    spoil(bad);
    EXPECT_THROW(heightsOf(bad, Eigen::Isometry3d::Identity(), someGrid()), InvalidParameter);
  }
}

}  // namespace
}  // namespace shallow_sand
