#include "shallow_sand/ros/sand_states.h"

#include <ros/console.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <sstream>
#include <utility>

#include "shallow_sand/core/replace_file.h"
#include "shallow_sand/scene/geotiff.h"
#include "shallow_sand/scene/state_folder.h"

namespace shallow_sand {
namespace {

namespace fs = std::filesystem;

/// Returns what was written, in words. @throws std::exception
std::string write(const fs::path& path, const SimulatorParameters& parameters, const Snapshot& state) {
  const ros::WallTime begin = ros::WallTime::now();
  fs::create_directories(path.parent_path());
  removeLeftParts(path);
  saveState(path.string(), parameters, state);
  std::ostringstream done;
  done << "the state at " << state.time << " s is in " << path.string() << ", "
       << (ros::WallTime::now() - begin).toSec() << " s later";
  return done.str();
}

/// Under a name that nothing else has, so that the next snapshot does not replace it. Returns the name.
std::string setAside(const fs::path& path) {
  for (int number = 0;; ++number) {
    const std::string extension = ".broken" + std::to_string(number) + path.extension().string();
    const fs::path aside = fs::path(path).replace_extension(extension);
    if (fs::exists(fs::symlink_status(aside))) continue;
    std::error_code error;
    fs::rename(path, aside, error);
    return error ? path.string() + " (" + error.message() + ")" : aside.string();
  }
}

}  // namespace

SandStates::SandStates(const ros::NodeHandle& node, LoopCalls& loop, const NodeParameters& parameters,
                       SandBodies& bodies, Simulator& simulator)
    : parameters_(parameters), bodies_(bodies), simulator_(simulator), services_(node, loop) {
  if (parameters.restore) restore();
  last_ = simulator_.time();
  services_.serve<StateFile>(
      "save", [this](const StateFile::Request& request, StateFile::Response&) { return save(request.file); });
  services_.serve<StateFile>(
      "load", [this](const StateFile::Request& request, StateFile::Response&) { return load(request.file); });
  services_.start();
}

std::string SandStates::save(const std::string& name) {
  const fs::path path = fileWithin(parameters_.state_folder, name);
  Snapshot state;
  SimulatorParameters sand;
  services_.inLoop([&] {
    state = simulator_.snapshot();
    sand = simulator_.parameters();
  });
  return write(path, sand, state);
}

std::string SandStates::load(const std::string& name) {
  const fs::path path = fileWithin(parameters_.state_folder, name);
  SimulatorParameters sand;
  services_.inLoop([&] { sand = simulator_.parameters(); });
  Snapshot state = loadState(path.string(), sand);
  std::ostringstream done;
  done << "the sand goes on from " << path.string() << " at " << state.time << " s";
  services_.inLoop([&] { goOnFrom(std::move(state)); });
  return done.str();
}

void SandStates::goOnFrom(Snapshot state) {
  // Robots may come later than the state; what their links held cannot wait for them.
  bodies_.restore(bodies_.status().empty() ? withoutBodies(std::move(state)) : state);
  last_ = simulator_.time();
}

void SandStates::restore() {
  const fs::path path = fileWithin(parameters_.state_folder, parameters_.snapshot_file);
  if (!fs::exists(path)) {
    ROS_INFO_STREAM("~restore: there is no " << path.string() << ": the sand starts anew");
    return;
  }
  try {
    goOnFrom(loadState(path.string(), simulator_.parameters()));
    ROS_INFO_STREAM("~restore: the sand goes on from " << path.string() << " at " << simulator_.time()
                                                       << " s");
  } catch (const std::exception& problem) {
    ROS_ERROR_STREAM("~restore: " << problem.what() << "; the sand starts anew, and the file is kept as "
                                  << setAside(path));
  }
}

void SandStates::saveIfDue() {
  if (!(parameters_.snapshot_period > 0.0)) return;
  if (writing_.valid()) {
    if (writing_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
    tellProblem();
  }
  const double now = simulator_.time();
  last_ = std::min(last_, now);  // ~reset may have gone back
  if (now - last_ < parameters_.snapshot_period) return;
  last_ = now;
  writing_ =
      std::async(std::launch::async, [this, sand = simulator_.parameters(), state = simulator_.snapshot()] {
        try {
          write(fileWithin(parameters_.state_folder, parameters_.snapshot_file), sand, state);
          return std::string();
        } catch (const std::exception& problem) {
          return std::string(problem.what());
        }
      });
}

void SandStates::tellProblem() {
  constexpr double kTellAgain = 60.0;
  const std::string problem = writing_.get();
  const ros::WallTime now = ros::WallTime::now();
  if (problem.empty() || (!told_.isZero() && (now - told_).toSec() < kTellAgain)) return;
  told_ = now;
  ROS_WARN_STREAM("a snapshot could not be written: " << problem << "; the sand goes on without it");
}

}  // namespace shallow_sand
