#include "shallow_sand/ros/pour_topic.h"

#include <ros/console.h>

#include <cmath>
#include <sstream>

#include "shallow_sand/solver/change_sand.h"

namespace shallow_sand {
namespace {

constexpr std::uint32_t kMostWaiting = 1000;
/// Between two lines of refusals [s].
constexpr double kTellAgain = 5.0;

std::string toText(double x, double y, double z) {
  std::ostringstream text;
  text << "(" << x << ", " << y << ", " << z << ")";
  return text.str();
}

/// Area of the cells that a disc covers. [m²]
double coveredArea(const Region& disc, const Grid& grid) {
  const LocalRegion local = localRegion(disc, grid);
  const Window window = windowOf(local, grid);
  double cells = 0.0;
  for (int j = window.row_begin; j < window.row_end; ++j) {
    for (int i = window.column_begin; i < window.column_end; ++i) {
      const float x = (static_cast<float>(i) + 0.5f) * grid.spacing;
      const float y = (static_cast<float>(j) + 0.5f) * grid.spacing;
      cells += local.holds(x, y) ? 1.0 : 0.0;
    }
  }
  return cells * grid.cellArea();
}

}  // namespace

PourTopic::PourTopic(ros::NodeHandle node, CallRecord& calls, const SandBodies& bodies, Simulator& simulator)
    : calls_(calls),
      bodies_(bodies),
      simulator_(simulator),
      subscriber_(node.subscribe<PourSand>(kName, kMostWaiting,
                                           [this](const PourSand::ConstPtr& message) { take(*message); })) {
  calls.know<PourSand>(kName, [this](const PourSand& message) -> Change {
    return [this, message] {
      pour(message);
      return std::string("poured");
    };
  });
}

void PourTopic::take(const PourSand& message) {
  try {
    calls_.make(kName, message);
  } catch (const std::exception& problem) {
    const ros::WallTime now = ros::WallTime::now();
    if (!told_.isZero() && (now - told_).toSec() < kTellAgain) return;
    told_ = now;
    ROS_WARN_STREAM(subscriber_.getTopic() << " is refused: " << problem.what());
  }
}

void PourTopic::pour(const PourSand& message) {
  const geometry_msgs::Point& point = message.position.point;
  const Eigen::Vector3d position(point.x, point.y, point.z);
  if (!position.allFinite())
    throw InvalidParameter("position", toText(point.x, point.y, point.z), "finite numbers");
  const Eigen::Vector3d in_sand = bodies_.poseOf(message.position.header.frame_id) * position;
  simulator_.edit(editOf(in_sand, message.radius, message.volume, simulator_.grid()));
}

Edit PourTopic::editOf(const Eigen::Vector3d& in_sand, double radius, double volume, const Grid& grid) {
  const double longest = grid.spacing * static_cast<double>(std::max(grid.columns, grid.rows));
  if (!(radius > 0.0 && radius <= longest)) {
    throw InvalidParameter("radius", std::to_string(radius),
                           "metres above 0, at most the grid's " + std::to_string(longest));
  }
  Edit edit;
  edit.region.center = in_sand.head<2>();
  edit.region.radius = radius;
  const double area = coveredArea(edit.region, grid);
  if (!(area > 0.0)) {
    throw InvalidParameter("position", toText(in_sand.x(), in_sand.y(), in_sand.z()) + " in the sand's frame",
                           "a disc that covers cells of the grid");
  }
  edit.operation = volume < 0.0 ? EditOperation::remove : EditOperation::add;
  edit.value = std::abs(volume) / area;
  constexpr double kDeepest = 1e6;
  if (!(edit.value <= kDeepest)) {
    throw InvalidParameter("volume", std::to_string(volume),
                           "cubic metres, no more than a million metres deep on the disc");
  }
  return edit;
}

}  // namespace shallow_sand
