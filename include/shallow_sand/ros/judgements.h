#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "shallow_sand/Status.h"
#include "shallow_sand/sim/simulator.h"

namespace shallow_sand {

/// What a person should know about a part of the node, and do. Levels are those of diagnostic_msgs.
struct Judgement {
  enum Level { ok = 0, warn = 1, error = 2 };
  Level level = ok;
  std::string text;
  std::vector<std::pair<std::string, std::string>> figures = {};  ///< name and value with its unit
};

/// How the sand kept up with ROS time since it was judged the last time.
struct Pace {
  double asked = 0.0;      ///< by how much ROS time went on [s]
  double simulated = 0.0;  ///< by how much the sand did [s]
  double given_up = 0.0;   ///< what was asked and not simulated, since the start [s]
};

/// @param status the last one; none: ROS time has not begun yet
Judgement judgeSolver(const Pace& pace, const std::optional<Status>& status);
Judgement judgeVolume(const std::optional<Status>& status);
Judgement judgeBodies(const std::optional<Status>& status);
/// @param notice see Simulator::backendNotice @param has_cuda whether this build holds the CUDA backend
Judgement judgeBackend(Backend wanted, Backend used, const std::string& notice, bool has_cuda);
/// @param silences why topics are silent, one text each
Judgement judgePublishers(const std::vector<std::string>& silences);

}  // namespace shallow_sand
