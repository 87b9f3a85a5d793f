#include "shallow_sand/ros/link_loader.h"

#include <ros/console.h>
#include <ros/time.h>

#include <chrono>
#include <functional>
#include <utility>

#include "shallow_sand/bodies/body_geometry.h"

namespace shallow_sand {
namespace {

std::string joined(const std::vector<std::string>& names, const std::string& separator = ", ") {
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : separator) + name;
  return all.empty() ? "none" : all;
}

void warnOfUnmatched(const std::string& about, const std::string& pattern,
                     const std::vector<std::string>& available) {
  ROS_WARN_STREAM(about << "pattern '" << pattern << "' matches no link; expected one that matches some of "
                        << "these links with collision geometry: " << joined(available));
}

/// Tells of a share that is done, every five seconds.
std::function<void(double)> progressOf(const std::string& what) {
  return [what, told = ros::WallTime::now()](double share) mutable {
    if ((ros::WallTime::now() - told).toSec() < 5.0) return;
    told = ros::WallTime::now();
    ROS_INFO_STREAM(what << ": " << static_cast<int>(100.0 * share) << " % sampled");
  };
}

}  // namespace

LinkLoader::LinkLoader(std::string urdf, LinkPatterns patterns, LinkShapes shapes, double sand_spacing)
    : urdf_(std::move(urdf)),
      patterns_(std::move(patterns)),
      shapes_(std::move(shapes)),
      sand_spacing_(sand_spacing),
      work_(std::async(std::launch::async, [this] { load(); })) {}

LinkLoader::~LinkLoader() { stop_ = true; }

std::vector<LinkLoader::Link> LinkLoader::takeReady() {
  if (work_.valid() && work_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) work_.get();
  const std::lock_guard<std::mutex> lock(mutex_);
  return std::exchange(ready_, {});
}

void LinkLoader::load() {
  const LinkSelection selection = selectLinks(urdf_, patterns_);
  const RobotGeometry robot = collisionGeometry(selection.urdf);
  const std::string about = "robot " + robot.robot + ": ";
  for (const std::string& pattern : selection.unmatched) {
    warnOfUnmatched(about, pattern, selection.available);
  }
  for (const std::string& pattern : unmatchedPatterns(shapes_, selection.available)) {
    warnOfUnmatched(about + "shapes: ", pattern, selection.available);
  }
  for (const std::string& problem : robot.problems) ROS_ERROR_STREAM(problem);
  std::size_t usable = 0;
  for (std::size_t k = 0; k < robot.links.size() && !stop_; ++k) {
    const LinkGeometry& link = robot.links[k];
    try {
      const std::string count = std::to_string(k + 1) + " of " + std::to_string(robot.links.size());
      Link ready{robot.robot, link.link, sample(robot.robot, link, count)};
      const std::lock_guard<std::mutex> lock(mutex_);
      ready_.push_back(std::move(ready));
      ++usable;
    } catch (const std::exception& problem) {
      ROS_ERROR_STREAM(about << "link " << link.link << " is left out: " << problem.what());
    }
  }
  if (usable == 0 && !stop_) {
    ROS_ERROR_STREAM(about << "none of its links has collision geometry that is chosen and can be read; it "
                           << "leaves no trace in the sand");
  }
}

std::shared_ptr<const DistanceField> LinkLoader::sample(const std::string& robot, const LinkGeometry& link,
                                                        const std::string& count) const {
  const std::string about = "robot " + robot + ": link " + link.link;
  const ros::WallTime begin = ros::WallTime::now();
  BodyGeometryOptions options;
  options.shape = shapeOf(shapes_, link.link);
  options.cache = defaultCacheFolder();
  options.progress = progressOf(about + " (" + count + ")");
  const BodyGeometry geometry = makeBodyGeometry(link.mesh, sand_spacing_, options);
  ROS_INFO_STREAM(about << " (" << count << ") " << (geometry.from_cache ? "taken from the cache" : "sampled")
                        << " in " << (ros::WallTime::now() - begin).toSec() << " s");
  if (geometry.notes.empty()) return geometry.field;
  // A body too large to sample finely is often one in other units.
  const bool coarse = geometry.field->spacing > 0.5 * sand_spacing_ * (1.0 + 1e-9);
  ROS_LOG_STREAM(coarse ? ros::console::levels::Warn : ros::console::levels::Info, ROSCONSOLE_DEFAULT_NAME,
                 about << ": " << joined(geometry.notes, "; "));
  return geometry.field;
}

}  // namespace shallow_sand
