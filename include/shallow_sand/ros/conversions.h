#pragma once

#include <ros/time.h>
#include <sensor_msgs/PointCloud2.h>
#include <visualization_msgs/Marker.h>

#include <string>

#include "shallow_sand/core/fields.h"
#include "shallow_sand/core/grid.h"

namespace shallow_sand {

/// The surface as an organised cloud (width: columns, height: rows): x, y, z, and the depth of the sand as
/// intensity. [m]
sensor_msgs::PointCloud2 toPointCloud(const Grid& grid, const Fields& fields, const std::string& frame,
                                      const ros::Time& stamp);

/// The surface as a TRIANGLE_LIST with a colour for each corner.
visualization_msgs::Marker toMarker(const Grid& grid, const Fields& fields, const std::string& frame,
                                    const ros::Time& stamp);

}  // namespace shallow_sand
