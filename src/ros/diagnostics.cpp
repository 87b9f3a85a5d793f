#include "shallow_sand/ros/diagnostics.h"

#include <utility>

namespace shallow_sand {
namespace {

const ros::WallDuration kPeriod(1.0);

#ifdef SHALLOW_SAND_WITH_CUDA
constexpr bool kHasCuda = true;
#else
constexpr bool kHasCuda = false;
#endif

}  // namespace

Diagnostics::Diagnostics(const ros::NodeHandle& node, const ros::NodeHandle& private_node, Backend wanted,
                         const Simulator& simulator, const std::vector<std::string>& silences)
    : next_(ros::WallTime::now() + kPeriod), updater_(node, private_node, private_node.getNamespace()) {
  updater_.setHardwareID("none");
  add("solver", [this] { return judgeSolver(pace_, status_); });
  add("volume", [this] { return judgeVolume(status_); });
  add("bodies", [this] { return judgeBodies(status_); });
  const Judgement backend = judgeBackend(wanted, simulator.backend(), simulator.backendNotice(), kHasCuda);
  add("backend", [backend] { return backend; });
  const Judgement publishers = judgePublishers(silences);
  add("publishers", [publishers] { return publishers; });
}

void Diagnostics::add(const std::string& name, std::function<Judgement()> judge) {
  updater_.add(name, [judge = std::move(judge)](diagnostic_updater::DiagnosticStatusWrapper& status) {
    const Judgement judgement = judge();
    status.summary(static_cast<unsigned char>(judgement.level), judgement.text);
    for (const auto& figure : judgement.figures) status.add(figure.first, figure.second);
  });
}

void Diagnostics::noteFrame(double asked, double simulated) {
  pace_.asked += asked;
  pace_.simulated += simulated;
  pace_.given_up += asked - simulated;
}

void Diagnostics::publishIfDue() {
  const ros::WallTime now = ros::WallTime::now();
  if (now < next_) return;
  next_ = now + kPeriod;
  updater_.force_update();
  pace_.asked = pace_.simulated = 0.0;
}

}  // namespace shallow_sand
