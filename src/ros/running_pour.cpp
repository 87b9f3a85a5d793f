#include "shallow_sand/ros/running_pour.h"

#include "shallow_sand/ros/pour_topic.h"
#include "shallow_sand/ros/requested_edits.h"

namespace shallow_sand {
namespace {

/// In the sand's frame.
PourSand pourOf(double volume, const Eigen::Vector2d& position, double radius) {
  PourSand message;
  message.position.point.x = position.x();
  message.position.point.y = position.y();
  message.radius = radius;
  message.volume = volume;
  return message;
}

}  // namespace

RunningPour::RunningPour(const NodeParameters& parameters, const CallRecord& calls, const Grid& grid)
    : parameters_(parameters), calls_(calls) {
  require(parameters.pour_rate, {parameters.pour_x, parameters.pour_y}, parameters.pour_radius, grid);
}

void RunningPour::pour(double duration) const {
  if (parameters_.pour_rate == 0.0) return;
  calls_.make(PourTopic::kName, pourOf(parameters_.pour_rate * duration,
                                       {parameters_.pour_x, parameters_.pour_y}, parameters_.pour_radius));
}

void RunningPour::require(double rate, const Eigen::Vector2d& position, double radius, const Grid& grid) {
  if (rate != 0.0) requestedEdit(pourOf(rate, position, radius), Eigen::Isometry3d::Identity(), grid);
}

}  // namespace shallow_sand
