#include "shallow_sand/ros/running_pour.h"

#include "shallow_sand/ros/pour_topic.h"

namespace shallow_sand {

RunningPour::RunningPour(const NodeParameters& parameters, const CallRecord& calls, const Grid& grid)
    : parameters_(parameters), calls_(calls) {
  require(parameters.pour_rate, {parameters.pour_x, parameters.pour_y}, parameters.pour_radius, grid);
}

void RunningPour::pour(double duration) const {
  if (parameters_.pour_rate == 0.0) return;
  PourSand message;
  message.position.point.x = parameters_.pour_x;
  message.position.point.y = parameters_.pour_y;
  message.radius = parameters_.pour_radius;
  message.volume = parameters_.pour_rate * duration;
  calls_.make(PourTopic::kName, message);
}

void RunningPour::require(double rate, const Eigen::Vector2d& position, double radius, const Grid& grid) {
  if (rate != 0.0) PourTopic::editOf({position.x(), position.y(), 0.0}, radius, rate, grid);
}

}  // namespace shallow_sand
