// How often rviz shows new sand, and how old that is by then: the height field's display against a stock
// Marker display of the same sand, one after the other. To be started by rviz_benchmark.launch.
#include <ros/ros.h>
#include <rviz/display_group.h>
#include <rviz/visualization_manager.h>
#include <visualization_msgs/Marker.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <string>
#include <vector>

#include "rviz/rviz_window.h"
#include "shallow_sand/client/height_field_subscriber.h"

namespace shallow_sand {
namespace {

struct Pace {
  double updates = 0.0;     ///< frames with new sand, a second
  double frames = 0.0;      ///< a second
  double median_age = 0.0;  ///< of the sand when it is drawn, against ROS time [s]
  double longest_age = 0.0;
};

void print(const char* name, const Pace& pace) {
  std::printf(
      "%-12s %6.2f updates a second, %6.2f frames a second; age of the sand shown: median %.3f s, at most "
      "%.3f s\n",
      name, pace.updates, pace.frames, pace.median_age, pace.longest_age);
}

/// Lets rviz run. @param newest time of the sand that was received last
Pace measure(RvizWindow& window, const ros::Time& newest, double seconds) {
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  const std::uint64_t first_frame = window.manager().getFrameCount();
  ros::Time shown = newest;
  std::vector<double> ages;
  while (std::chrono::duration<double>(Clock::now() - begin).count() < seconds) {
    window.runFrames(1, 60.0);
    if (newest == shown) continue;
    shown = newest;
    ages.push_back((ros::Time::now() - shown).toSec());
  }
  const double elapsed = std::chrono::duration<double>(Clock::now() - begin).count();
  Pace pace;
  pace.updates = static_cast<double>(ages.size()) / elapsed;
  pace.frames = static_cast<double>(window.manager().getFrameCount() - first_frame) / elapsed;
  if (ages.empty()) return pace;
  std::sort(ages.begin(), ages.end());
  pace.median_age = ages[ages.size() / 2];
  pace.longest_age = ages.back();
  return pace;
}

void run(RvizWindow& window, double seconds) {
  ros::NodeHandle node;
  ros::Time newest;
  {
    const HeightFieldSubscriber subscriber(
        node, "/sand_node/height_field",
        [&](const HeightField& map, const HeightFieldMap::Change&) { newest = map.header.stamp; });
    window.runUntil([&] { return !window.sand()->mapFrame().empty() && !newest.isZero(); }, 60.0);
    window.runFrames(10, 60.0);
    print("HeightField", measure(window, newest, seconds));
  }
  rviz::Display* sand = window.sand();
  sand->setEnabled(false);
  rviz::Display* marker = window.manager().createDisplay("rviz/Marker", "Mesh", true);
  marker->setTopic("/sand_node/mesh", "visualization_msgs/Marker");
  newest = ros::Time();
  const ros::Subscriber subscriber = node.subscribe<visualization_msgs::Marker>(
      "/sand_node/mesh", 1,
      [&](const visualization_msgs::Marker::ConstPtr& message) { newest = message->header.stamp; });
  window.runUntil([&] { return !newest.isZero(); }, 60.0);
  window.runFrames(2, 60.0);
  print("Marker", measure(window, newest, seconds));
}

}  // namespace
}  // namespace shallow_sand

int main(int argc, char** argv) {
  ros::init(argc, argv, "rviz_benchmark", ros::init_options::NoSigintHandler);
  shallow_sand::RvizWindow window(argc, argv, SHALLOW_SAND_SOURCE_DIR "/config/excavator/excavation.rviz");
  shallow_sand::run(window, argc > 1 ? std::stod(argv[1]) : 20.0);
  return 0;
}
