#include "shallow_sand/ros/sand_node.h"

#include <algorithm>

#include "shallow_sand/Status.h"
#include "shallow_sand/scene/mesh_file.h"
#include "shallow_sand/scene/picture.h"
#include "shallow_sand/scene/report.h"
#include "shallow_sand/scene/simulation.h"

namespace shallow_sand {

namespace {

/// Sand time that one frame may catch up [s]; what lies further back is given up, so that a slow machine
/// stays responsive and a paused one does not race afterwards.
constexpr double kLongestFrame = 0.1;

Simulator build(const Scene& scene) {
  std::vector<std::string> notes;
  Simulator simulator = buildSimulator(scene, &notes);
  for (const std::string& note : notes) ROS_INFO_STREAM(note);
  return simulator;
}

SandConstants constantsOf(const Simulator& simulator) {
  const SimulatorParameters& parameters = simulator.parameters();
  return sandConstants(simulator.grid(), parameters.gravity, parameters.material);
}

}  // namespace

SandNode::SandNode()
    : parameters_(readNodeParameters(private_node_)),
      simulator_(build(parameters_.scene)),
      bodies_(parameters_, transforms_, simulator_),
      states_(loop_calls_, parameters_, bodies_, simulator_),
      services_(loop_calls_, simulator_.grid().spacing, bodies_),
      editing_(loop_calls_, bodies_, simulator_),
      setting_(loop_calls_, bodies_, simulator_),
      queries_(loop_calls_, bodies_, simulator_),
      pour_(private_node_, bodies_, simulator_),
      body_markers_(private_node_, parameters_.scene.parameters.grid.frame),
      body_handles_(parameters_.scene.parameters.grid.frame, 1.0 / parameters_.frame_rate, bodies_),
      height_field_(private_node_, simulator_.grid(), parameters_.scene.parameters.grid.frame,
                    constantsOf(simulator_), parameters_.height_field_rate, parameters_.publish_speed),
      surface_(private_node_, simulator_.grid(), parameters_.scene.parameters.grid.frame,
               parameters_.publish_rate, static_cast<std::size_t>(parameters_.mesh_cells)) {
  if (simulator_.parameters().grains) {
    particles_.emplace(private_node_, simulator_.grid(), parameters_.scene.parameters.grid.frame,
                       parameters_.publish_rate);
  }
  for (const RobotParameters& robot : parameters_.robots) {
    robots_.emplace_back(robot, parameters_.robots.size() == 1, simulator_.grid().spacing);
  }
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
    loop_calls_.runPending();
    states_.saveIfDue();
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
  last_frame_ = last_status_ = ros::Time();
  transforms_.restart();
  bodies_.restartClock();
}

void SandNode::update(const ros::Time& time) {
  for (Robot& robot : robots_) robot.update(node_, bodies_);
  beginAdvance(time);
  // From the GPU they have come while the frame before ended, and this one runs already.
  handOverFields();
  const ros::WallTime begin = ros::WallTime::now();
  simulator_.time();  // waits for the GPU
  busy_ += (ros::WallTime::now() - begin).toSec();
  if (last_status_.isZero() || time - last_status_ >= ros::Duration(1.0)) publishStatus(time);
  showBodies();
  if (particles_ && particles_->isDue()) particles_->send(simulator_.grains(), simulator_.fields(), time);
  requestFields(time);
  // The CPU has computed all before it returned: fields need not wait for a frame.
  if (simulator_.backend() == Backend::cpu) handOverFields();
}

void SandNode::beginAdvance(const ros::Time& time) {
  const double elapsed = last_frame_.isZero() ? 0.0 : (time - last_frame_).toSec();
  last_frame_ = time;
  if (!(elapsed > 0.0)) return;
  const double frame = std::min(elapsed, kLongestFrame);
  const double end = simulator_.time() + frame;
  bodies_.update(time, frame, end);
  const ros::WallTime begin = ros::WallTime::now();
  simulator_.beginAdvanceTo(end);
  busy_ += (ros::WallTime::now() - begin).toSec();
}

void SandNode::showBodies() {
  const ros::WallTime now = ros::WallTime::now();
  if ((now - last_bodies_).toSec() < 1.0 / parameters_.publish_rate) return;
  last_bodies_ = now;
  const std::vector<ShownBody> shown = bodies_.shown();
  body_markers_.update(shown);
  body_handles_.update(shown);
}

void SandNode::requestFields(const ros::Time& time) {
  if (requested_ || !(height_field_.follower().isDue() || surface_.follower().isDue())) return;
  simulator_.requestFields();
  requested_ = time;
}

void SandNode::handOverFields() {
  if (!requested_) return;
  const Fields& fields = simulator_.collectFields();
  const std::vector<Window> changes = simulator_.takeChanges();
  for (FieldsFollower* follower : {&height_field_.follower(), &surface_.follower()}) {
    follower->note(changes);
    if (follower->isDue()) follower->send(fields, *requested_);
  }
  requested_.reset();
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
  if (!parameters_.picture.empty()) {
    const Fields fields = simulator_.fields();
    writePicture(parameters_.picture, simulator_.grid(), fields, {},
                 grainCloud(simulator_.grid(), fields, simulator_.grains()));
  }
  if (!parameters_.mesh_file.empty()) {
    writeMesh(parameters_.mesh_file, surfaceMesh(simulator_.grid(), simulator_.fields()));
  }
}

}  // namespace shallow_sand
