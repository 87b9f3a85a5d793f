#pragma once

#include <ros/node_handle.h>

#include <string>

#include "shallow_sand/ros/fields_follower.h"

namespace shallow_sand {

/// Publishes ~points and ~mesh, both latched, in a thread of its own.
class SurfacePublisher {
 public:
  /// @param node whose name the topics begin with @param rate of both [Hz]
  /// @param most_mesh_cells in ~mesh; a larger map is shown by blocks of cells
  SurfacePublisher(ros::NodeHandle node, const Grid& grid, const std::string& frame, double rate,
                   std::size_t most_mesh_cells);
  ~SurfacePublisher() { follower_.stop(); }

  /// Why ~points stays silent on such a map; empty if it does not.
  static std::string silence(const Grid& grid);
  /// What the sand's thread hands fields to.
  FieldsFollower& follower() { return follower_; }

 private:
  void take(const FieldsChange& change, const ros::Time& stamp);

  Grid grid_;
  std::string frame_;
  std::size_t most_mesh_cells_;
  Fields fields_;  ///< of the follower's thread, as all that follows
  FieldsFollower follower_;
  ros::Publisher points_;
  ros::Publisher mesh_;
};

}  // namespace shallow_sand
