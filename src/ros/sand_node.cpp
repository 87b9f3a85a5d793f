#include "shallow_sand/ros/sand_node.h"

#include <algorithm>
#include <cmath>

#include "shallow_sand/Status.h"
#include "shallow_sand/scene/mesh_file.h"
#include "shallow_sand/scene/picture.h"
#include "shallow_sand/scene/report.h"
#include "shallow_sand/scene/simulation.h"

namespace shallow_sand {

namespace {

/// Frames that are late are caught up for so long at a time, so that nobody waits longer for an answer [s].
constexpr double kLongestTurn = 0.1;
/// Of sand in one call of ~step [s].
constexpr double kLongestStep = 10.0;

ros::NodeHandle withQueue(ros::NodeHandle node, ros::CallbackQueue& queue) {
  node.setCallbackQueue(&queue);
  return node;
}

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

/// Of publishers, for the size of the map.
std::vector<std::string> silences(const Grid& grid) {
  std::vector<std::string> silences;
  for (const std::string& silence : {HeightFieldPublisher::silence(grid), SurfacePublisher::silence(grid)}) {
    if (!silence.empty()) silences.push_back(silence);
  }
  return silences;
}

}  // namespace

SandNode::SandNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node)
    : node_(withQueue(node, queue_)),
      private_node_(withQueue(private_node, queue_)),
      parameters_(readNodeParameters(private_node_)),
      simulator_(build(parameters_.scene)),
      clock_(parameters_.frame_rate),
      bodies_(parameters_, clock_, transforms_, simulator_),
      calls_(private_node_, clock_, parameters_.scene.parameters.grid.frame),
      states_(private_node_, loop_calls_, parameters_, bodies_, simulator_),
      services_(private_node_, loop_calls_, calls_, parameters_.scene.parameters.grid, bodies_, transforms_),
      editing_(private_node_, loop_calls_, calls_, bodies_, simulator_),
      setting_(private_node_, loop_calls_, bodies_, simulator_),
      queries_(private_node_, loop_calls_, bodies_, simulator_),
      pour_(private_node_, calls_, bodies_, simulator_),
      running_pour_(parameters_, calls_, simulator_.grid()),
      body_markers_(private_node_, parameters_.scene.parameters.grid.frame),
      body_handles_(private_node_, parameters_.scene.parameters.grid.frame, clock_, calls_, bodies_),
      height_field_(private_node_, simulator_.grid(), parameters_.scene.parameters.grid.frame,
                    constantsOf(simulator_), parameters_.height_field_rate, parameters_.publish_speed),
      surface_(private_node_, simulator_.grid(), parameters_.scene.parameters.grid.frame,
               parameters_.publish_rate, static_cast<std::size_t>(parameters_.mesh_cells)),
      contacts_(private_node_, parameters_.scene.depth, parameters_.scene.parameters.grid.frame,
                parameters_.publish_rate),
      replay_(private_node_, parameters_.replay_calls, calls_, clock_),
      diagnostics_(node_, private_node_, parameters_.scene.parameters.backend, simulator_,
                   silences(simulator_.grid())),
      reconfiguration_(private_node_, parameters_, simulator_, [this] { takeParameters(); }),
      paused_(parameters_.paused),
      rate_(parameters_.frame_rate) {
  if (simulator_.parameters().grains) {
    particles_.emplace(private_node_, simulator_.grid(), parameters_.scene.parameters.grid.frame,
                       parameters_.publish_rate);
  }
  for (const RobotParameters& robot : parameters_.robots) {
    robots_.emplace_back(robot, parameters_.robots.size() == 1, simulator_.grid().spacing);
  }
  status_ = private_node_.advertise<Status>("status", 1, true);
  pause_ = private_node_.advertiseService("pause", &SandNode::pause, this);
  step_ = private_node_.advertiseService("step", &SandNode::step, this);
  calls_.know<std_srvs::Trigger::Request>(
      "reset", [this](const auto&) -> Change { return [this] { return startAnew(); }; });
  reset_ = private_node_.advertiseService("reset", &SandNode::reset, this);
  ROS_INFO_STREAM(simulator_.backendNotice());
  ROS_INFO_STREAM(simulator_.grid().columns << " x " << simulator_.grid().rows << " cells of "
                                            << simulator_.grid().spacing << " m in frame "
                                            << parameters_.scene.parameters.grid.frame);
}

void SandNode::run(const std::function<bool()>& goesOn) {
  while (ros::ok() && goesOn()) {
    turn();
    diagnostics_.publishIfDue();
    rate_.sleep();
  }
  writeResults();
}

void SandNode::turn() {
  queue_.callAvailable();
  loop_calls_.runPending();
  replay_.carryOutDue();
  states_.saveIfDue();
  for (Robot& robot : robots_) robot.update(node_, bodies_);
  const ros::Time now = ros::Time::now();
  if (now < last_now_) restart(last_now_ - now);
  last_now_ = now;
  if (sandTime().isZero()) return;
  if (!paused_ || !clock_.hasStarted()) runDueFrames(sandTime());
  // Those of the GPU if no frame has run meanwhile.
  handOverFields();
  publish();
}

ros::Time SandNode::sandTime() const {
  // Simulated time starts at zero, and there is no time before that.
  if (last_now_.toSec() <= parameters_.tf_delay) return ros::Time();
  return last_now_ - ros::Duration(parameters_.tf_delay);
}

void SandNode::restart(const ros::Duration& duration) {
  ROS_WARN_STREAM("time went back by " << duration.toSec() << " s; the sand goes on from here, and bodies "
                                       << "are put at their next poses");
  clock_.restart();
  replay_.restart(ros::Time::now());
  transforms_.restart();
  bodies_.restartClock();
}

void SandNode::runDueFrames(const ros::Time& now) {
  const ros::WallTime begin = ros::WallTime::now();
  const double simulated = simulator_.time();
  const double given_up = clock_.givenUp();
  while (clock_.due(now) > 0 && (ros::WallTime::now() - begin).toSec() < kLongestTurn) runFrame();
  const double ran = simulator_.time() - simulated;
  diagnostics_.noteFrame(ran + (clock_.givenUp() - given_up), ran);
  if (clock_.givenUp() - told_given_up_ < FrameClock::kMostBehind) return;
  ROS_WARN_STREAM_THROTTLE(
      10.0, "the sand left out " << clock_.givenUp() - told_given_up_
                                 << " s of ROS time: the machine is too slow for it, or time leapt (see "
                                    "real_time_factor in ~status; fewer or larger cells, a slower clock or "
                                    "more threads help)");
  told_given_up_ = clock_.givenUp();
}

void SandNode::runFrame() {
  replay_.carryOutDue();
  running_pour_.pour(clock_.length());
  const ros::Time time = clock_.next();
  const double end = simulator_.time() + clock_.length();
  bodies_.update(time, clock_.length(), end);
  const std::uint64_t steps = simulator_.progress().steps;
  const ros::WallTime begin = ros::WallTime::now();
  simulator_.beginAdvanceTo(end);
  // From the GPU they have come while the frame before ended, and this one runs already.
  handOverFields();
  simulator_.time();  // waits for the GPU
  busy_ += (ros::WallTime::now() - begin).toSec();
  simulated_since_status_ += clock_.length();
  steps_in_frame_ = simulator_.progress().steps - steps;
}

void SandNode::publish() {
  if ((ros::WallTime::now() - last_status_).toSec() >= 1.0) publishStatus();
  showBodies();
  if (particles_ && particles_->isDue())
    particles_->send(simulator_.grains(), simulator_.fields(), clock_.end());
  if (contacts_.isDue() && clock_.hasStarted()) contacts_.send(simulator_, clock_.end());
  requestFields();
  // The CPU has computed all before it returned: fields need not wait for a frame.
  if (simulator_.backend() == Backend::cpu) handOverFields();
}

bool SandNode::pause(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response) {
  if (paused_ && !request.data && clock_.hasStarted()) {
    clock_.skipTo(std::max(sandTime(), clock_.end()));
    bodies_.restartClock();
  }
  paused_ = request.data != 0;
  publishStatus();
  response.success = true;
  response.message = paused_ ? "paused" : "running";
  return true;
}

bool SandNode::step(Step::Request& request, Step::Response& response) {
  try {
    stepBy(request.duration);
    response.success = true;
    response.message = "done";
  } catch (const InvalidParameter& problem) {
    response.success = false;
    response.message = problem.what();
    ROS_WARN_STREAM_THROTTLE(5.0, "~step is refused: " << problem.what());
  }
  response.simulated_time = simulator_.time();
  // False would be a failure of the call, without a message.
  return true;
}

void SandNode::stepBy(double duration) {
  if (!paused_) throw InvalidParameter("~step", "running sand", "sand that ~pause has stopped");
  if (!(duration >= 0.0 && duration <= kLongestStep)) {
    throw InvalidParameter("duration", std::to_string(duration),
                           "seconds from 0 to " + std::to_string(kLongestStep));
  }
  if (!clock_.hasStarted())
    throw InvalidParameter("~step", "no ROS time yet", "a clock beyond ~tf_delay (use_sim_time is set)");
  const auto frames = std::max<std::int64_t>(1, std::llround(duration / clock_.length()));
  // Where time went on further than the sand goes now, what lies between is left out.
  const double passed = sandTime().toSec() - clock_.end().toSec();
  const double surplus = passed - static_cast<double>(frames) * clock_.length();
  if (surplus > 0.0) {
    clock_.skipTo(clock_.end() + ros::Duration(surplus));
    bodies_.restartClock();
  }
  const ros::WallTime deadline = ros::WallTime::now() + ros::WallDuration(parameters_.tf_timeout);
  for (std::int64_t frame = 0; frame < frames; ++frame) {
    waitForPoses(clock_.end() + ros::Duration(clock_.length()), deadline);
    runFrame();
  }
  requestFields();
  handOverFields();
}

void SandNode::waitForPoses(const ros::Time& time, const ros::WallTime& deadline) const {
  while (ros::ok() && !bodies_.posesHaveCome(time) && ros::WallTime::now() < deadline)
    ros::WallDuration(0.001).sleep();
}

bool SandNode::reset(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response) {
  response.message = calls_.make("reset", request);
  response.success = true;
  return true;
}

std::string SandNode::startAnew() {
  bodies_.restore(startOf(parameters_.scene));
  publishStatus();
  const std::string done = "the sand is as it was at the start";
  ROS_INFO_STREAM("~reset: " << done);
  return done;
}

void SandNode::takeParameters() {
  clock_.setRate(parameters_.frame_rate);
  rate_ = ros::WallRate(parameters_.frame_rate);
  surface_.follower().setRate(parameters_.publish_rate);
  if (particles_) particles_->setRate(parameters_.publish_rate);
  contacts_.setRate(parameters_.publish_rate);
  height_field_.follower().setRate(parameters_.height_field_rate);
  bodies_.setFastest(parameters_.max_body_speed);
}

void SandNode::showBodies() {
  const ros::WallTime now = ros::WallTime::now();
  if ((now - last_bodies_).toSec() < 1.0 / parameters_.publish_rate) return;
  last_bodies_ = now;
  const std::vector<ShownBody> shown = bodies_.shown();
  body_markers_.update(shown);
  body_handles_.update(shown);
}

void SandNode::requestFields() {
  if (requested_ || !clock_.hasStarted() ||
      !(height_field_.follower().isDue() || surface_.follower().isDue()))
    return;
  simulator_.requestFields();
  requested_ = clock_.end();
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

void SandNode::publishStatus() {
  const SandFigures figures = simulator_.figures();
  const Ledger& ledger = figures.ledger;
  const ros::WallTime wall = ros::WallTime::now();
  const double wall_elapsed = (wall - last_status_).toSec();
  Status status;
  status.header.stamp = clock_.hasStarted() ? clock_.end() : ros::Time();
  status.header.frame_id = parameters_.scene.parameters.grid.frame;
  status.backend = toString(simulator_.backend());
  status.simulated_time = simulator_.time();
  status.real_time_factor = last_status_.isZero() ? 0.0 : simulated_since_status_ / wall_elapsed;
  status.paused = paused_;
  if (clock_.hasStarted()) status.behind = std::max(0.0, (sandTime() - clock_.end()).toSec());
  status.time_given_up = clock_.givenUp();
  status.steps_in_frame = static_cast<std::uint32_t>(steps_in_frame_);
  status.steps = simulator_.progress().steps;
  status.cells = static_cast<std::uint32_t>(simulator_.grid().cells());
  status.active_cells = static_cast<std::uint32_t>(figures.active_cells);
  status.max_speed = figures.max_speed;
  status.volume_start = ledger.start;
  status.volume_poured = ledger.poured;
  status.volume_left = ledger.left;
  status.volume = ledger.now;
  status.volume_error = ledger.error();
  status.body_overlap = simulator_.bodyOverlap();
  status.bodies = bodies_.status();
  status_.publish(status);
  diagnostics_.take(status);
  last_status_ = wall;
  simulated_since_status_ = 0.0;
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
