#include "shallow_sand/ros/judgements.h"

#include <sstream>

namespace shallow_sand {
namespace {

constexpr double kSlow = 0.95;        ///< of ROS time
constexpr double kLargeError = 1e-6;  ///< of the volume; roundings stay below
constexpr double kHugeError = 1e-3;
constexpr std::size_t kMostNamed = 5;  ///< bodies in a text

template <class T>
std::string text(const T& value, const char* unit = "") {
  std::ostringstream stream;
  stream << value << unit;
  return stream.str();
}

const char* const kNoTime = "ROS time has not begun: use_sim_time is true, and nothing publishes /clock yet";

std::string nameOf(const BodyStatus& body) {
  return (body.robot.empty() ? "" : body.robot + ": ") + body.name;
}

}  // namespace

Judgement judgeSolver(const Pace& pace, const std::optional<Status>& status) {
  if (!status) return {Judgement::warn, kNoTime};
  Judgement judgement;
  judgement.figures = {{"simulated time", text(status->simulated_time, " s")},
                       {"real-time factor", text(status->real_time_factor)},
                       {"time given up", text(pace.given_up, " s")},
                       {"steps", text(status->steps)},
                       {"cells", text(status->cells)},
                       {"cells that move", text(status->active_cells)},
                       {"fastest sand", text(status->max_speed, " m/s")}};
  if (status->paused) {
    judgement.text = "the sand is paused; ~pause with false lets it run, ~step runs it on";
  } else if (!(pace.asked > 0.0)) {
    judgement.text = "ROS time stands still, and so does the sand";
  } else if (pace.simulated < kSlow * pace.asked) {
    judgement.level = Judgement::warn;
    judgement.text =
        "the sand ran at " + text(pace.simulated / pace.asked) + " of ROS time and gave up " +
        text(pace.asked - pace.simulated, " s") +
        "; use a larger grid.spacing, fewer or simpler links (include, shapes), more threads or a "
        "GPU (backend)";
  } else {
    judgement.text = "the sand keeps up with ROS time";
  }
  return judgement;
}

Judgement judgeVolume(const std::optional<Status>& status) {
  if (!status) return {Judgement::ok, "no sand has moved yet"};
  Judgement judgement;
  judgement.figures = {
      {"error", text(status->volume_error)},           {"start", text(status->volume_start, " m^3")},
      {"poured", text(status->volume_poured, " m^3")}, {"left", text(status->volume_left, " m^3")},
      {"now", text(status->volume, " m^3")},           {"inside bodies", text(status->body_overlap, " m^3")}};
  // A number that is none is the worst of all.
  if (status->volume_error <= kLargeError) {
    judgement.text = "no sand is lost";
    return judgement;
  }
  judgement.level = status->volume_error <= kHugeError ? Judgement::warn : Judgement::error;
  judgement.text = "a part of " + text(status->volume_error) +
                   " of the sand was lost or made up; what is measured on it is off by as much: restart the "
                   "node, and report scene and log as a bug";
  return judgement;
}

Judgement judgeBodies(const std::optional<Status>& status) {
  Judgement judgement;
  judgement.text = "no bodies";
  if (!status || status->bodies.empty()) return judgement;
  std::size_t missing = 0;
  std::string names;
  for (const BodyStatus& body : status->bodies) {
    if (body.state != BodyStatus::WAITING && body.state != BodyStatus::STALE) continue;
    const char* state = body.state == BodyStatus::WAITING ? "WAITING" : "STALE";
    const std::string problem = body.problem.empty() ? "no pose yet" : body.problem;
    judgement.figures.emplace_back(nameOf(body),
                                   std::string(state) + ", frame " + body.frame + ": " + problem);
    if (++missing <= kMostNamed)
      names += (missing == 1 ? "" : "; ") + nameOf(body) + " " + state + " (" + problem + ")";
  }
  if (missing == 0) {
    judgement.text = "all " + text(status->bodies.size()) + " bodies are where they should be";
    return judgement;
  }
  if (missing > kMostNamed) names += "; and " + text(missing - kMostNamed) + " more";
  judgement.level = Judgement::warn;
  judgement.text = text(missing) + " of " + text(status->bodies.size()) + " bodies get no pose: " + names +
                   "; see who publishes tf from the frame of the sand to theirs";
  return judgement;
}

Judgement judgeBackend(Backend wanted, Backend used, const std::string& notice, bool has_cuda) {
  Judgement judgement;
  judgement.text = notice;
  judgement.figures = {{"backend", toString(used)}, {"asked for", toString(wanted)}};
  if (wanted == Backend::automatic && used == Backend::cpu && has_cuda) {
    judgement.level = Judgement::warn;
    judgement.text += "; mend the GPU, or set backend: cpu if this is what you want";
  }
  return judgement;
}

Judgement judgePublishers(const std::vector<std::string>& silences) {
  Judgement judgement;
  judgement.text = "no topic is silent for the size of the map";
  if (silences.empty()) return judgement;
  judgement.level = Judgement::warn;
  judgement.text = silences.front();
  for (std::size_t k = 1; k < silences.size(); ++k) judgement.text += "; " + silences[k];
  judgement.text += "; use a larger grid.spacing or a smaller grid.size";
  return judgement;
}

}  // namespace shallow_sand
