#include "shallow_sand/ros/link_loader.h"

#include <ros/console.h>
#include <ros/time.h>

#include <chrono>
#include <utility>

#include "shallow_sand/bodies/robot_links.h"
#include "shallow_sand/ros/sand_bodies.h"

namespace shallow_sand {
namespace {

std::string joined(const std::vector<std::string>& names) {
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
  return all.empty() ? "none" : all;
}

}  // namespace

LinkLoader::LinkLoader(std::string urdf, LinkPatterns patterns, double sand_spacing)
    : work_(std::async(std::launch::async, [this, urdf = std::move(urdf), patterns = std::move(patterns),
                                            sand_spacing] { load(urdf, patterns, sand_spacing); })) {}

LinkLoader::~LinkLoader() { stop_ = true; }

std::vector<LinkLoader::Link> LinkLoader::takeReady() {
  if (work_.valid() && work_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) work_.get();
  const std::lock_guard<std::mutex> lock(mutex_);
  return std::exchange(ready_, {});
}

void LinkLoader::load(const std::string& urdf, const LinkPatterns& patterns, double sand_spacing) {
  const LinkSelection selection = selectLinks(urdf, patterns);
  const RobotGeometry robot = collisionGeometry(selection.urdf);
  const std::string about = "robot " + robot.robot + ": ";
  for (const std::string& pattern : selection.unmatched) {
    ROS_WARN_STREAM(about << "pattern '" << pattern
                          << "' matches no link; expected one that matches some of these links with "
                          << "collision geometry: " << joined(selection.available));
  }
  for (const std::string& problem : robot.problems) ROS_ERROR_STREAM(problem);
  std::size_t usable = 0;
  for (std::size_t k = 0; k < robot.links.size() && !stop_; ++k) {
    const LinkGeometry& geometry = robot.links[k];
    const ros::WallTime begin = ros::WallTime::now();
    try {
      Link link{robot.robot, geometry.link, bodyField(geometry.mesh, sand_spacing)};
      ROS_INFO_STREAM(about << "link " << geometry.link << " (" << k + 1 << " of " << robot.links.size()
                            << ") sampled in " << (ros::WallTime::now() - begin).toSec() << " s");
      const std::lock_guard<std::mutex> lock(mutex_);
      ready_.push_back(std::move(link));
      ++usable;
    } catch (const std::exception& problem) {
      ROS_ERROR_STREAM(about << "link " << geometry.link << " is left out: " << problem.what());
    }
  }
  if (usable == 0 && !stop_) {
    ROS_ERROR_STREAM(about << "none of its links has collision geometry that is chosen and can be read; it "
                           << "leaves no trace in the sand");
  }
}

}  // namespace shallow_sand
