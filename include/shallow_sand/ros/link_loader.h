#pragma once

#include <atomic>
#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "shallow_sand/bodies/distance_field.h"
#include "shallow_sand/bodies/link_selection.h"

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
  LinkLoader(std::string urdf, LinkPatterns patterns, double sand_spacing);
  /// Waits for the link under way.
  ~LinkLoader();

  /// What has become ready since the last call. @throws InvalidParameter, once, if it is no URDF
  std::vector<Link> takeReady();

 private:
  void load(const std::string& urdf, const LinkPatterns& patterns, double sand_spacing);

  std::atomic<bool> stop_{false};
  std::mutex mutex_;
  std::vector<Link> ready_;
  std::future<void> work_;  ///< last: it uses the rest
};

}  // namespace shallow_sand
