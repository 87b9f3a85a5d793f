#pragma once

#include "shallow_sand/ros/call_record.h"
#include "shallow_sand/ros/node_parameters.h"
#include "shallow_sand/solver/change_sand.h"

namespace shallow_sand {

/// The pour of ~pour_rate and its company: what falls within a frame is there when it begins, as if a message
/// on ~pour had brought it, and is recorded as such.
class RunningPour {
 public:
  /// Both must outlive this. @throws InvalidParameter, see require
  RunningPour(const NodeParameters& parameters, const CallRecord& calls, const Grid& grid);
  /// To be called before each frame, that is so long [s].
  void pour(double duration) const;
  /// @throws InvalidParameter if it runs, and its disc covers no cell or is larger than the grid
  static void require(double rate, const Eigen::Vector2d& position, double radius, const Grid& grid);

 private:
  const NodeParameters& parameters_;
  const CallRecord& calls_;
};

}  // namespace shallow_sand
