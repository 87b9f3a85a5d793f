#pragma once

#include <ros/time.h>
#include <sensor_msgs/PointCloud2.h>
#include <visualization_msgs/Marker.h>

#include <string>

#include "shallow_sand/core/fields.h"
#include "shallow_sand/core/grid.h"
#include "shallow_sand/particles/grains.h"

namespace shallow_sand {

/// The surface as an organised cloud (width: columns, height: rows): x, y, z, and the depth of the sand as
/// intensity [m]; and rgb, the colour as rviz and PCL pack it.
sensor_msgs::PointCloud2 toPointCloud(const Grid& grid, const Fields& fields, const std::string& frame,
                                      const ros::Time& stamp);

/// Grains: x, y, z [m] and rgb, in the light that falls on the sand where they are.
sensor_msgs::PointCloud2 toPointCloud(const Grid& grid, const Fields& fields, const GrainCloud& grains,
                                      const std::string& frame, const ros::Time& stamp);

/// Most cells that a marker holds whatever they look like: one takes 240 bytes, thrice that where a shore
/// cuts all its triangles and as much again where it has a load, and ROS drops messages of a gigabyte.
constexpr std::size_t kMostMarkerCells = 1000000;

/// The surface's mesh as a TRIANGLE_LIST with a colour for each corner, at the finest level of detail with at
/// most so many cells.
visualization_msgs::Marker toMarker(const Grid& grid, const Fields& fields, std::size_t most_cells,
                                    const std::string& frame, const ros::Time& stamp);

}  // namespace shallow_sand
