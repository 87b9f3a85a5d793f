#pragma once

#include <sensor_msgs/PointCloud2.h>
#include <visualization_msgs/Marker.h>

#include <Eigen/Geometry>

#include "shallow_sand/core/fields.h"
#include "shallow_sand/core/grid.h"

namespace shallow_sand {

/// Mean height of the points in each cell [m]. Fields x, y and z must be FLOAT32, little-endian. Points that
/// are not finite do not count, unless the cloud says that it has none.
/// @param pose of the message's frame in the grid's
/// @throws InvalidParameter naming the field of the message, before anything is read beyond its data
CellValues heightsOf(const sensor_msgs::PointCloud2& cloud, const Eigen::Isometry3d& pose, const Grid& grid);

/// Height of the highest triangle over the middle of each cell [m]; the same for a TRIANGLE_LIST.
CellValues heightsOf(const visualization_msgs::Marker& marker, const Eigen::Isometry3d& pose,
                     const Grid& grid);

}  // namespace shallow_sand
