#include "shallow_sand/ros/conversions.h"

#include <sensor_msgs/point_cloud2_iterator.h>

#include "shallow_sand/surface/surface.h"

namespace shallow_sand {
namespace {

void add(visualization_msgs::Marker& marker, const Surface& surface,
         const std::vector<std::size_t>& corners) {
  for (const std::size_t corner : corners) {
    geometry_msgs::Point point;
    point.x = surface.points[corner].x();
    point.y = surface.points[corner].y();
    point.z = surface.points[corner].z();
    marker.points.push_back(point);
    std_msgs::ColorRGBA color;
    color.r = surface.colors[corner].x();
    color.g = surface.colors[corner].y();
    color.b = surface.colors[corner].z();
    color.a = 1.0f;
    marker.colors.push_back(color);
  }
}

}  // namespace

sensor_msgs::PointCloud2 toPointCloud(const Grid& grid, const Fields& fields, const std::string& frame,
                                      const ros::Time& stamp) {
  sensor_msgs::PointCloud2 cloud;
  cloud.header.frame_id = frame;
  cloud.header.stamp = stamp;
  cloud.is_dense = true;
  sensor_msgs::PointCloud2Modifier modifier(cloud);
  constexpr int kFloat = sensor_msgs::PointField::FLOAT32;
  modifier.setPointCloud2Fields(4, "x", 1, kFloat, "y", 1, kFloat, "z", 1, kFloat, "intensity", 1, kFloat);
  modifier.resize(grid.cells());
  cloud.width = static_cast<std::uint32_t>(grid.columns);
  cloud.height = static_cast<std::uint32_t>(grid.rows);
  cloud.row_step = cloud.width * cloud.point_step;
  sensor_msgs::PointCloud2Iterator<float> value(cloud, "x");
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i, ++value) {
      const std::size_t k = grid.index(i, j);
      value[0] = static_cast<float>(grid.x(i));
      value[1] = static_cast<float>(grid.y(j));
      value[2] = fields.surface(k);
      value[3] = fields.allDepth(k);
    }
  }
  return cloud;
}

visualization_msgs::Marker toMarker(const Grid& grid, const Fields& fields, const std::string& frame,
                                    const ros::Time& stamp) {
  visualization_msgs::Marker marker;
  marker.header.frame_id = frame;
  marker.header.stamp = stamp;
  marker.ns = "sand";
  marker.type = visualization_msgs::Marker::TRIANGLE_LIST;
  marker.action = visualization_msgs::Marker::ADD;
  marker.pose.orientation.w = 1.0;
  marker.scale.x = marker.scale.y = marker.scale.z = 1.0;
  marker.color.a = 1.0f;
  const std::vector<std::size_t> ground = surfaceTriangles(grid);
  const std::vector<std::size_t> loads = loadTriangles(grid, fields);
  marker.points.reserve(ground.size() + loads.size());
  marker.colors.reserve(ground.size() + loads.size());
  add(marker, groundSurface(grid, fields), ground);
  if (!loads.empty()) add(marker, visibleSurface(grid, fields), loads);
  return marker;
}

}  // namespace shallow_sand
