#include "shallow_sand/ros/conversions.h"

#include <sensor_msgs/point_cloud2_iterator.h>

#include <algorithm>
#include <cstring>

#include "shallow_sand/surface/blocks.h"
#include "shallow_sand/surface/surface_colour.h"
#include "shallow_sand/surface/surface_mesh.h"

namespace shallow_sand {
namespace {

geometry_msgs::Point toPoint(const Eigen::Vector3d& position) {
  geometry_msgs::Point point;
  point.x = position.x();
  point.y = position.y();
  point.z = position.z();
  return point;
}

std_msgs::ColorRGBA toColor(const Eigen::Vector3f& colour) {
  std_msgs::ColorRGBA color;
  color.r = colour.x();
  color.g = colour.y();
  color.b = colour.z();
  color.a = 1.0f;
  return color;
}

constexpr int kFloat = sensor_msgs::PointField::FLOAT32;

/// Without fields and points.
sensor_msgs::PointCloud2 cloudIn(const std::string& frame, const ros::Time& stamp) {
  sensor_msgs::PointCloud2 cloud;
  cloud.header.frame_id = frame;
  cloud.header.stamp = stamp;
  cloud.is_dense = true;
  return cloud;
}

/// 0x00rrggbb in the bits of a float.
float packed(const Eigen::Vector3f& colour) {
  const Eigen::Array<std::uint32_t, 3, 1> bytes = (255.0f * colour.array() + 0.5f).cast<std::uint32_t>();
  const std::uint32_t bits = bytes[0] << 16 | bytes[1] << 8 | bytes[2];
  float value;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

}  // namespace

sensor_msgs::PointCloud2 toPointCloud(const Grid& grid, const Fields& fields, const std::string& frame,
                                      const ros::Time& stamp) {
  sensor_msgs::PointCloud2 cloud = cloudIn(frame, stamp);
  sensor_msgs::PointCloud2Modifier modifier(cloud);
  modifier.setPointCloud2Fields(5, "x", 1, kFloat, "y", 1, kFloat, "z", 1, kFloat, "intensity", 1, kFloat,
                                "rgb", 1, kFloat);
  modifier.resize(grid.cells());
  cloud.width = static_cast<std::uint32_t>(grid.columns);
  cloud.height = static_cast<std::uint32_t>(grid.rows);
  cloud.row_step = cloud.width * cloud.point_step;
  const std::vector<Eigen::Vector3f> colours = visibleColours(grid, fields);
  sensor_msgs::PointCloud2Iterator<float> value(cloud, "x");
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i, ++value) {
      const std::size_t k = grid.index(i, j);
      value[0] = static_cast<float>(grid.x(i));
      value[1] = static_cast<float>(grid.y(j));
      value[2] = fields.surface(k);
      value[3] = fields.allDepth(k);
      value[4] = packed(colours[k]);
    }
  }
  return cloud;
}

sensor_msgs::PointCloud2 toPointCloud(const Grid& grid, const Fields& fields, const GrainCloud& grains,
                                      const std::string& frame, const ros::Time& stamp) {
  sensor_msgs::PointCloud2 cloud = cloudIn(frame, stamp);
  sensor_msgs::PointCloud2Modifier modifier(cloud);
  modifier.setPointCloud2Fields(4, "x", 1, kFloat, "y", 1, kFloat, "z", 1, kFloat, "rgb", 1, kFloat);
  modifier.resize(grains.points.size());
  const std::vector<float> light = visibleLight(grid, fields);
  const auto cellAlong = [&](float position, double origin, int cells) {
    const double cell = (static_cast<double>(position) - origin) / static_cast<double>(grid.spacing);
    return std::clamp(static_cast<int>(cell), 0, cells - 1);
  };
  sensor_msgs::PointCloud2Iterator<float> value(cloud, "x");
  for (std::size_t k = 0; k < grains.points.size(); ++k, ++value) {
    value[0] = grains.points[k].x();
    value[1] = grains.points[k].y();
    value[2] = grains.points[k].z();
    const int i = cellAlong(value[0], grid.origin_x, grid.columns);
    const int j = cellAlong(value[1], grid.origin_y, grid.rows);
    value[3] = packed((light[grid.index(i, j)] * grains.colors[k]).cwiseMin(1.0f));
  }
  return cloud;
}

visualization_msgs::Marker toMarker(const Grid& grid, const Fields& fields, std::size_t most_cells,
                                    const std::string& frame, const ros::Time& stamp) {
  visualization_msgs::Marker marker;
  marker.header.frame_id = frame;
  marker.header.stamp = stamp;
  marker.ns = "sand";
  marker.type = visualization_msgs::Marker::TRIANGLE_LIST;
  marker.action = visualization_msgs::Marker::ADD;
  marker.pose.orientation.w = 1.0;
  marker.scale.x = marker.scale.y = marker.scale.z = 1.0;
  marker.color.a = 1.0f;
  const SurfaceMesh mesh = surfaceMesh(grid, fields, finestLevel(grid, most_cells));
  std::vector<std_msgs::ColorRGBA> colors(mesh.positions.size());
  for (std::size_t vertex = 0; vertex < colors.size(); ++vertex)
    colors[vertex] = toColor(mesh.colour(vertex));
  marker.points.reserve(3 * mesh.triangles());
  marker.colors.reserve(3 * mesh.triangles());
  mesh.forEachTriangle([&](const SurfaceMesh::Triangle& triangle) {
    for (const std::uint32_t corner : triangle) {
      marker.points.push_back(toPoint(mesh.positions[corner]));
      marker.colors.push_back(colors[corner]);
    }
  });
  return marker;
}

}  // namespace shallow_sand
