#include "shallow_sand/ros/surface_publisher.h"

#include <ros/console.h>

#include <boost/make_shared.hpp>

#include "shallow_sand/ros/conversions.h"

namespace shallow_sand {
namespace {

/// In ~points.
constexpr std::size_t kMostCellsShown = 4000000;

}  // namespace

SurfacePublisher::SurfacePublisher(ros::NodeHandle node, const Grid& grid, const std::string& frame,
                                   double rate, std::size_t most_mesh_cells)
    : grid_(grid),
      frame_(frame),
      most_mesh_cells_(most_mesh_cells),
      follower_(grid, rate,
                [this](const FieldsChange& change, const ros::Time& stamp) { take(change, stamp); }) {
  points_ = node.advertise<sensor_msgs::PointCloud2>("points", 1, true);
  mesh_ = node.advertise<visualization_msgs::Marker>("mesh", 1, true);
  follower_.start();
  follower_.wake();
  if (!silence(grid).empty()) ROS_WARN_STREAM(silence(grid));
}

std::string SurfacePublisher::silence(const Grid& grid) {
  if (grid.cells() <= kMostCellsShown) return "";
  return "~points stays silent: " + std::to_string(grid.cells()) + " cells are more than " +
         std::to_string(kMostCellsShown);
}

// Messages are shared: subscribers in the same process get them without a copy.
void SurfacePublisher::take(const FieldsChange& change, const ros::Time& stamp) {
  const bool is_first = fields_.depth.empty();
  apply(change, grid_, fields_);
  // Latched, so whoever comes later must find the sand as it is.
  if (silence(grid_).empty()) {
    points_.publish(
        boost::make_shared<const sensor_msgs::PointCloud2>(toPointCloud(grid_, fields_, frame_, stamp)));
  }
  // Dear: made only when somebody looks, or once, so that whoever comes later sees sand at once.
  if (mesh_.getNumSubscribers() > 0 || is_first) {
    mesh_.publish(boost::make_shared<const visualization_msgs::Marker>(
        toMarker(grid_, fields_, most_mesh_cells_, frame_, stamp)));
  }
}

}  // namespace shallow_sand
