#include "shallow_sand/ros/sand_node.h"

#include <algorithm>

#include "shallow_sand/Status.h"
#include "shallow_sand/ros/conversions.h"
#include "shallow_sand/scene/mesh_file.h"
#include "shallow_sand/scene/picture.h"
#include "shallow_sand/scene/report.h"
#include "shallow_sand/scene/simulation.h"

namespace shallow_sand {

namespace {

/// Sand time that one frame may catch up [s]; what lies further back is given up, so that a slow machine
/// stays responsive and a paused one does not race afterwards.
constexpr double kLongestFrame = 0.1;

/// In ~points.
constexpr std::size_t kMostCellsShown = 4000000;

Simulator build(const Scene& scene) {
  std::vector<std::string> notes;
  Simulator simulator = buildSimulator(scene, &notes);
  for (const std::string& note : notes) ROS_INFO_STREAM(note);
  return simulator;
}

}  // namespace

SandNode::SandNode()
    : parameters_(readNodeParameters(private_node_)),
      simulator_(build(parameters_.scene)),
      bodies_(parameters_, transforms_, simulator_),
      services_(parameters_.scene.parameters.grid.frame, simulator_.grid().spacing, bodies_) {
  for (const RobotParameters& robot : parameters_.robots) {
    robots_.emplace_back(robot, parameters_.robots.size() == 1, simulator_.grid().spacing);
  }
  points_ = private_node_.advertise<sensor_msgs::PointCloud2>("points", 1, true);
  mesh_ = private_node_.advertise<visualization_msgs::Marker>("mesh", 1, true);
  status_ = private_node_.advertise<Status>("status", 1, true);
  ROS_INFO_STREAM(simulator_.backendNotice());
  ROS_INFO_STREAM(simulator_.grid().columns << " x " << simulator_.grid().rows << " cells of "
                                            << simulator_.grid().spacing << " m in frame "
                                            << parameters_.scene.parameters.grid.frame);
}

void SandNode::run() {
  ros::WallRate rate(parameters_.frame_rate);
  const ros::Duration delay(parameters_.tf_delay);
  while (ros::ok()) {
    ros::spinOnce();
    services_.runPending();
    const ros::Time now = ros::Time::now();
    if (now < last_now_) restart(last_now_ - now);
    last_now_ = now;
    // Simulated time starts at zero, and there is no time before that.
    if (now.toSec() > parameters_.tf_delay) update(now - delay);
    rate.sleep();
  }
  writeResults();
}

void SandNode::restart(const ros::Duration& duration) {
  ROS_WARN_STREAM("time went back by " << duration.toSec() << " s; the sand goes on from here, and bodies "
                                       << "are put at their next poses");
  last_frame_ = last_surface_ = last_status_ = ros::Time();
  transforms_.restart();
  bodies_.restartClock();
}

void SandNode::update(const ros::Time& time) {
  for (Robot& robot : robots_) robot.update(node_, bodies_);
  advance(time);
  const ros::Duration surface_period(1.0 / parameters_.publish_rate);
  if (last_surface_.isZero() || time - last_surface_ >= surface_period) publishSurface(time);
  if (last_status_.isZero() || time - last_status_ >= ros::Duration(1.0)) publishStatus(time);
}

void SandNode::advance(const ros::Time& time) {
  const double elapsed = last_frame_.isZero() ? 0.0 : (time - last_frame_).toSec();
  last_frame_ = time;
  if (!(elapsed > 0.0)) return;
  const double frame = std::min(elapsed, kLongestFrame);
  const double end = simulator_.time() + frame;
  bodies_.update(time, frame, end);
  const ros::WallTime begin = ros::WallTime::now();
  simulator_.advanceTo(end);
  busy_ += (ros::WallTime::now() - begin).toSec();
}

void SandNode::publishSurface(const ros::Time& time) {
  const std::string& frame = parameters_.scene.parameters.grid.frame;
  const bool with_points = simulator_.grid().cells() <= kMostCellsShown;
  if (!with_points) {
    ROS_WARN_STREAM_ONCE("~points stays silent: " << simulator_.grid().cells() << " cells are more than "
                                                  << kMostCellsShown);
  }
  // A mesh takes forty bytes a corner: made only when somebody looks, or once, so that whoever comes later
  // sees sand.
  const bool with_mesh = mesh_.getNumSubscribers() > 0 || last_surface_.isZero();
  last_surface_ = time;
  if (!with_points && !with_mesh) return;
  const Fields fields = simulator_.fields();
  if (with_points) points_.publish(toPointCloud(simulator_.grid(), fields, frame, time));
  if (with_mesh) {
    mesh_.publish(
        toMarker(simulator_.grid(), fields, static_cast<std::size_t>(parameters_.mesh_cells), frame, time));
  }
}

void SandNode::publishStatus(const ros::Time& time) {
  const Ledger ledger = simulator_.ledger();
  const ros::WallTime wall = ros::WallTime::now();
  const double wall_elapsed = (wall - last_status_wall_).toSec();
  Status status;
  status.header.stamp = time;
  status.header.frame_id = parameters_.scene.parameters.grid.frame;
  status.backend = toString(simulator_.backend());
  status.simulated_time = simulator_.time();
  status.real_time_factor =
      last_status_.isZero() ? 0.0 : (simulator_.time() - last_status_simulated_) / wall_elapsed;
  status.steps = simulator_.progress().steps;
  status.cells = static_cast<std::uint32_t>(simulator_.grid().cells());
  status.active_cells = static_cast<std::uint32_t>(simulator_.activeCells());
  status.max_speed = simulator_.maxSpeed();
  status.volume_start = ledger.start;
  status.volume_poured = ledger.poured;
  status.volume_left = ledger.left;
  status.volume = ledger.now;
  status.volume_error = ledger.error();
  status.body_overlap = simulator_.bodyOverlap();
  status.bodies = bodies_.status();
  status_.publish(status);
  last_status_ = time;
  last_status_wall_ = wall;
  last_status_simulated_ = simulator_.time();
}

void SandNode::writeResults() const {
  if (!parameters_.report.empty()) {
    writeReport(parameters_.report, makeReport(simulator_, parameters_.scene.name, busy_));
  }
  if (!parameters_.picture.empty()) writePicture(parameters_.picture, simulator_.grid(), simulator_.fields());
  if (!parameters_.mesh_file.empty()) {
    writeMesh(parameters_.mesh_file, surfaceMesh(simulator_.grid(), simulator_.fields()));
  }
}

}  // namespace shallow_sand
