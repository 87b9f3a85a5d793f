#include "shallow_sand/ros/pour_topic.h"

#include <ros/console.h>

#include "shallow_sand/core/one_line.h"
#include "shallow_sand/ros/requested_edits.h"

namespace shallow_sand {
namespace {

constexpr std::uint32_t kMostWaiting = 1000;
/// Between two lines of refusals [s].
constexpr double kTellAgain = 5.0;

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
    ROS_WARN_STREAM(subscriber_.getTopic() << " is refused: " << oneLine(problem.what()));
  }
}

void PourTopic::pour(const PourSand& message) {
  const Eigen::Isometry3d frame = bodies_.poseOf(message.position.header.frame_id);
  simulator_.edit(requestedEdit(message, frame, simulator_.grid()));
}

}  // namespace shallow_sand
