#include "shallow_sand/ros/message_heights.h"

#include <sensor_msgs/PointField.h>

#include <cmath>
#include <cstring>
#include <sstream>

#include "shallow_sand/core/parameters.h"
#include "shallow_sand/ros/poses.h"
#include "shallow_sand/surface/cell_heights.h"

namespace shallow_sand {
namespace {

/// Where in a point the bytes of a coordinate are.
std::size_t offsetOf(const sensor_msgs::PointCloud2& cloud, const std::string& name) {
  for (const sensor_msgs::PointField& field : cloud.fields) {
    if (field.name != name) continue;
    if (field.datatype != sensor_msgs::PointField::FLOAT32 || field.count > 1) {
      throw InvalidParameter(
          "fields " + name,
          "datatype " + std::to_string(field.datatype) + ", count " + std::to_string(field.count),
          "one FLOAT32 (datatype 7)");
    }
    if (field.offset > cloud.point_step || cloud.point_step - field.offset < sizeof(float)) {
      throw InvalidParameter("fields " + name, "offset " + std::to_string(field.offset),
                             "4 bytes within a point_step of " + std::to_string(cloud.point_step));
    }
    return field.offset;
  }
  throw InvalidParameter("fields " + name, "missing", "fields x, y and z");
}

/// By divisions: products of what a message may say do not fit 64 bits.
void requireSizes(const sensor_msgs::PointCloud2& cloud) {
  const std::size_t data = cloud.data.size();
  const bool fits = cloud.width == 0 || cloud.height == 0 ||
                    (cloud.point_step > 0 && cloud.row_step / cloud.point_step >= cloud.width &&
                     data / cloud.row_step >= cloud.height);
  const bool is_whole =
      cloud.height == 0 ? data == 0 : data % cloud.height == 0 && data / cloud.height == cloud.row_step;
  if (fits && is_whole) return;
  std::ostringstream found;
  found << "width " << cloud.width << ", height " << cloud.height << ", point_step " << cloud.point_step
        << ", row_step " << cloud.row_step << " and " << data << " bytes of data";
  throw InvalidParameter("cloud", found.str(),
                         "rows of width points within row_step, and height times row_step bytes");
}

void requireFinite(const std::string& key, const Eigen::Vector3d& position) {
  if (position.allFinite()) return;
  std::ostringstream found;
  found << "(" << position.x() << ", " << position.y() << ", " << position.z() << ")";
  throw InvalidParameter(key, found.str(), "finite numbers");
}

}  // namespace

CellValues heightsOf(const sensor_msgs::PointCloud2& cloud, const Eigen::Isometry3d& pose, const Grid& grid) {
  if (cloud.is_bigendian) throw InvalidParameter("is_bigendian", "true", "false");
  requireSizes(cloud);
  const std::size_t offsets[]{offsetOf(cloud, "x"), offsetOf(cloud, "y"), offsetOf(cloud, "z")};
  MeanHeights heights(grid);
  // Rows of no points have no bytes that would bound their number.
  const std::uint32_t rows = cloud.width == 0 ? 0 : cloud.height;
  for (std::uint32_t row = 0; row < rows; ++row) {
    for (std::uint32_t column = 0; column < cloud.width; ++column) {
      const std::size_t at = static_cast<std::size_t>(row) * cloud.row_step +
                             static_cast<std::size_t>(column) * cloud.point_step;
      Eigen::Vector3f point;
      for (int k = 0; k < 3; ++k) std::memcpy(&point[k], cloud.data.data() + at + offsets[k], sizeof(float));
      if (point.allFinite()) {
        heights.add(pose * point.cast<double>());
      } else if (cloud.is_dense) {
        requireFinite("point of a cloud that is_dense", point.cast<double>());
      }
    }
  }
  return heights.values();
}

CellValues heightsOf(const visualization_msgs::Marker& marker, const Eigen::Isometry3d& pose,
                     const Grid& grid) {
  if (marker.type != visualization_msgs::Marker::TRIANGLE_LIST ||
      marker.action != visualization_msgs::Marker::ADD) {
    throw InvalidParameter(
        "marker", "type " + std::to_string(marker.type) + ", action " + std::to_string(marker.action),
        "a TRIANGLE_LIST (type 11) to ADD (action 0)");
  }
  if (marker.points.size() % 3 != 0) {
    throw InvalidParameter("points", std::to_string(marker.points.size()), "three for each triangle");
  }
  const Eigen::Vector3d scale(marker.scale.x, marker.scale.y, marker.scale.z);
  requireFinite("scale", scale);
  const Eigen::Isometry3d in_grid = pose * rigid(marker.pose);
  const auto corner = [&](std::size_t k) -> Eigen::Vector3d {
    const Eigen::Vector3d point(marker.points[k].x, marker.points[k].y, marker.points[k].z);
    const Eigen::Vector3d position = in_grid * scale.cwiseProduct(point);
    requireFinite("points[" + std::to_string(k) + "]", position);
    return position;
  };
  HighestTriangles heights(grid);
  for (std::size_t k = 0; k < marker.points.size(); k += 3)
    heights.add(corner(k), corner(k + 1), corner(k + 2));
  return heights.values();
}

}  // namespace shallow_sand
