#include "shallow_sand/ros/surface_publisher.h"

#include <ros/console.h>

#include "shallow_sand/ros/conversions.h"

namespace shallow_sand {
namespace {

/// A mesh takes 240 bytes a cell, and ROS drops messages of a gigabyte.
constexpr std::size_t kMostCellsShown = 4000000;

}  // namespace

SurfacePublisher::SurfacePublisher(ros::NodeHandle node, const Grid& grid, const std::string& frame,
                                   double rate)
    : grid_(grid),
      frame_(frame),
      follower_(grid, rate,
                [this](const FieldsChange& change, const ros::Time& stamp) { take(change, stamp); }) {
  points_ = node.advertise<sensor_msgs::PointCloud2>("points", 1, true);
  mesh_ = node.advertise<visualization_msgs::Marker>("mesh", 1, true);
  follower_.start();
  if (grid.cells() <= kMostCellsShown) {
    follower_.wake();
  } else {
    ROS_WARN_STREAM(
        grid.cells() << " cells are more than a message can hold; ~points and ~mesh stay silent above "
                     << kMostCellsShown);
  }
}

void SurfacePublisher::take(const FieldsChange& change, const ros::Time& stamp) {
  const bool is_first = fields_.depth.empty();
  apply(change, grid_, fields_);
  points_.publish(toPointCloud(grid_, fields_, frame_, stamp));
  // A mesh takes forty bytes a corner: made only when somebody looks, or once, so that whoever comes later
  // sees sand.
  if (mesh_.getNumSubscribers() > 0 || is_first) mesh_.publish(toMarker(grid_, fields_, frame_, stamp));
}

}  // namespace shallow_sand
