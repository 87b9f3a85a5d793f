#pragma once

#include <atomic>
#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "shallow_sand/bodies/distance_field.h"
#include "shallow_sand/bodies/link_selection.h"
#include "shallow_sand/bodies/robot_links.h"
#include "shallow_sand/ros/link_shapes.h"

namespace shallow_sand {

/// Reads a robot's meshes and computes the distance fields of its links on a thread of its own, which may
/// take a minute, while the sand runs on. The log tells of progress, and of each link that is left out.
class LinkLoader {
 public:
  struct Link {
    std::string robot;  ///< name in the URDF
    std::string name;
    std::shared_ptr<const DistanceField> field;
  };
  LinkLoader(std::string urdf, LinkPatterns patterns, LinkShapes shapes, double sand_spacing);
  /// Waits for the link under way.
  ~LinkLoader();

  /// What has become ready since the last call. @throws InvalidParameter, once, if it is no URDF
  std::vector<Link> takeReady();

 private:
  void load();
  /// The field of a link, which the log tells of. @param count such as "3 of 7"
  std::shared_ptr<const DistanceField> sample(const std::string& robot, const LinkGeometry& link,
                                              const std::string& count) const;

  const std::string urdf_;
  const LinkPatterns patterns_;
  const LinkShapes shapes_;
  const double sand_spacing_;
  std::atomic<bool> stop_{false};
  std::mutex mutex_;
  std::vector<Link> ready_;
  std::future<void> work_;  ///< last: it uses the rest
};

}  // namespace shallow_sand
