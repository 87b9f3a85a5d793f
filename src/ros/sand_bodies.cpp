#include "shallow_sand/ros/sand_bodies.h"

#include <ros/console.h>
#include <tf2/exceptions.h>
#include <tf2_eigen/tf2_eigen.h>

#include <algorithm>
#include <limits>
#include <sstream>

#include "shallow_sand/bodies/motion.h"
#include "shallow_sand/scene/simulation.h"

namespace shallow_sand {
namespace {

Eigen::AlignedBox3d boxOf(const DistanceField& field) {
  const Eigen::Vector3d samples(field.samples[0] - 1, field.samples[1] - 1, field.samples[2] - 1);
  return {field.origin, field.origin + field.spacing * samples};
}

/// tf2 takes rotations whose length is a little off.
Eigen::Isometry3d rigid(const geometry_msgs::Transform& transform) {
  Eigen::Isometry3d pose = tf2::transformToEigen(transform);
  const auto& q = transform.rotation;
  pose.linear() = Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized().toRotationMatrix();
  return pose;
}

bool mayTell(ros::WallTime& told, double period) {
  const ros::WallTime now = ros::WallTime::now();
  if (!told.isZero() && (now - told).toSec() < period) return false;
  told = now;
  return true;
}

}  // namespace

SandBodies::SandBodies(const NodeParameters& parameters, const FrameClock& clock,
                       const TransformReader& transforms, Simulator& simulator)
    : sand_frame_(parameters.scene.parameters.grid.frame),
      tf_delay_(parameters.tf_delay),
      tf_timeout_(parameters.tf_timeout),
      max_body_speed_(parameters.max_body_speed),
      clock_(clock),
      transforms_(transforms),
      simulator_(simulator) {
  for (const SceneBody& scene_body : parameters.scene.bodies) {
    Body body;
    body.number = bodies_.size();  // the simulator has them in the scene's order
    const TriangleMesh mesh = triangulate(scene_body.shape);
    for (const Eigen::Vector3d& vertex : mesh.vertices) body.box.extend(vertex);
    body.of_scene = scene_body.motion;
    for (const PoseKey& key : body.of_scene) body.motion.append(key.time, key.pose);
    body.status.name = scene_body.name;
    body.status.state = BodyStatus::PLACED;
    body.appearance = BodyAppearance{lookOf(scene_body), false};
    bodies_.push_back(std::move(body));
  }
}

bool SandBodies::has(const std::string& name) const {
  return std::any_of(bodies_.begin(), bodies_.end(),
                     [&name](const Body& body) { return body.status.name == name; });
}

void SandBodies::requireFree(const std::string& name) const {
  if (name.empty()) throw InvalidParameter("name", "empty", "a name");
  if (has(name)) throw InvalidParameter("name", name, "a name that no other body has");
}

std::size_t SandBodies::indexOf(const std::string& name) const {
  std::string names;
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    if (bodies_[k].status.name == name) return k;
    names += (k == 0 ? "" : ", ") + bodies_[k].status.name;
  }
  throw InvalidParameter("name", name, names.empty() ? "a body, but there is none" : "one of " + names);
}

SandBodies::Body& SandBodies::add(const std::string& name,
                                  const std::shared_ptr<const DistanceField>& field) {
  requireFree(name);
  Body body;
  body.box = boxOf(*field);
  body.number = simulator_.addBody(name, field);
  body.status.name = name;
  bodies_.push_back(std::move(body));
  return bodies_.back();
}

void SandBodies::addFollowing(const std::string& name, const std::string& robot, const TfFrame& frame,
                              std::shared_ptr<const DistanceField> field,
                              std::optional<BodyAppearance> appearance) {
  Body& body = add(name, field);
  body.appearance = std::move(appearance);
  body.following = Following{frame, PoseTrack(body.box, max_body_speed_), {}, false, {}};
  body.status.robot = robot;
  body.status.frame = frame.name;
  body.status.state = BodyStatus::WAITING;
}

void SandBodies::addPlaced(const std::string& name, const Eigen::Isometry3d& pose,
                           std::shared_ptr<const DistanceField> field, const BodyAppearance& appearance) {
  Motion motion;
  motion.append(simulator_.time(), pose);
  Body& body = add(name, field);
  body.motion = motion;
  body.appearance = appearance;
  body.status.state = BodyStatus::PLACED;
  simulator_.placeBody(body.number, pose);
}

void SandBodies::remove(const std::string& name) {
  const std::size_t index = indexOf(name);
  simulator_.removeBody(bodies_[index].number);
  bodies_.erase(bodies_.begin() + static_cast<std::ptrdiff_t>(index));
}

void SandBodies::move(const std::string& name, const Eigen::Isometry3d& pose, double duration) {
  Body& body = bodies_[indexOf(name)];
  if (body.following) {
    throw InvalidParameter("name", name + ", which follows tf frame " + body.following->frame.name,
                           "a body that follows none");
  }
  if (!(duration >= 0.0) || duration > 1e9) {
    throw InvalidParameter("duration", std::to_string(duration), "seconds from 0 to 1e9");
  }
  const double now = simulator_.time();
  const Eigen::Isometry3d from = body.motion.poseAt(now);
  const double least = leastDuration(name, pose);
  if (duration > 0.0 && !(least <= duration)) {
    std::ostringstream expected;
    expected << "0 (it is put there), or at least " << least << " s for " << least * max_body_speed_
             << " m at ~max_body_speed";
    throw InvalidParameter("duration", std::to_string(duration) + " s", expected.str());
  }
  Motion motion;
  motion.append(now, duration > 0.0 ? from : pose);
  if (duration > 0.0) motion.append(now + duration, pose);
  body.motion = motion;
  body.strayed = true;
  simulator_.placeBody(body.number, motion.poseAt(now));
  if (duration > 0.0) simulator_.appendPose(body.number, now + duration, pose);
}

double SandBodies::leastDuration(const std::string& name, const Eigen::Isometry3d& pose) const {
  const Body& body = bodies_[indexOf(name)];
  return farthestMove(body.box, body.motion.poseAt(simulator_.time()), pose) / max_body_speed_;
}

Eigen::Isometry3d SandBodies::poseOf(const std::string& frame) const {
  if (frame.empty() || frame == sand_frame_) return Eigen::Isometry3d::Identity();
  const ros::Time now = clock_.hasStarted() ? clock_.end() : ros::Time();
  const bool is_known = transforms_.buffer().canTransform(sand_frame_, frame, now);
  return lookUp(TfFrame{frame, Eigen::Isometry3d::Identity()}, is_known ? now : ros::Time());
}

Eigen::Isometry3d SandBodies::lookUp(const TfFrame& frame, const ros::Time& time) const {
  const Eigen::Isometry3d pose =
      rigid(transforms_.buffer().lookupTransform(sand_frame_, frame.name, time).transform) * frame.offset;
  if (isWithinReach(pose)) return pose;
  std::ostringstream problem;
  problem << "it is at (" << pose.translation().transpose() << "); expected metres up to 1e9";
  throw tf2::InvalidArgumentException(problem.str());
}

void SandBodies::restartClock() {
  origin_ = last_end_ = leapt_ = ros::Time();
  for (Body& body : bodies_) {
    if (!body.following) continue;
    body.following->track.restart();
    body.following->failing = ros::Time();
  }
}

bool SandBodies::posesHaveCome(const ros::Time& time) const {
  return std::all_of(bodies_.begin(), bodies_.end(), [&](const Body& body) {
    return !body.following || body.status.state != BodyStatus::MOVING ||
           transforms_.buffer().canTransform(sand_frame_, body.following->frame.name, time);
  });
}

void SandBodies::restore(const Snapshot& snapshot) {
  const double before = simulator_.time();
  simulator_.restore(snapshot);
  restartClock();
  for (Body& body : bodies_) {
    if (body.following && !body.following->in_sand) continue;
    placeAnew(body, body.following ? body.following->pose : body.motion.poseAt(before));
  }
}

void SandBodies::placeAnew(Body& body, const Eigen::Isometry3d& rest) {
  // The simulator knows its way, and goes on with the same bits.
  if (!body.of_scene.empty() && !body.strayed) return;
  body.strayed = false;
  const double now = simulator_.time();
  Motion motion;
  if (body.of_scene.empty()) {
    motion.append(now, rest);
  } else {
    for (const PoseKey& key : body.of_scene) motion.append(key.time, key.pose);
  }
  body.motion = motion;
  simulator_.placeBody(body.number, motion.poseAt(now));
  for (const PoseKey& key : body.of_scene) {
    if (key.time > now) simulator_.appendPose(body.number, key.time, key.pose);
  }
}

void SandBodies::update(const ros::Time& end, double duration, double simulated_end) {
  if (origin_.isZero()) origin_ = end;
  const double time = (end - origin_).toSec();
  const ros::Time now = end + ros::Duration(tf_delay_);
  if (!last_end_.isZero() && (end - last_end_).toSec() > tf_timeout_) leapt_ = now;
  last_end_ = end;
  for (Body& body : bodies_) {
    if (body.following) follow(body, {time - duration, time, simulated_end}, now);
  }
  news_.tell();
  tellLate(duration);
}

void SandBodies::follow(Body& body, const FrameTimes& times, const ros::Time& now) {
  Following& following = *body.following;
  try {
    // A stamp of zero: nothing but static transforms, which hold for ever.
    const ros::Time stamp =
        transforms_.buffer().lookupTransform(sand_frame_, following.frame.name, ros::Time(0)).header.stamp;
    const double newest =
        stamp.isZero() ? std::numeric_limits<double>::infinity() : (stamp - origin_).toSec();
    body.status.age = stamp.isZero() ? 0.0 : (now - stamp).toSec();
    apply(body, following.track.follow(times, newest, [&](double time) {
      return lookUp(following.frame, origin_ + ros::Duration(time));
    }));
    following.in_sand = true;
    following.failing = ros::Time();
    // After a leap of the clock every pose is old for a moment.
    const bool stale = body.status.age > tf_timeout_ && (now - leapt_).toSec() > tf_timeout_;
    report(body, stale ? BodyStatus::STALE : BodyStatus::MOVING,
           stale ? "its newest pose is " + std::to_string(body.status.age) + " s old" : "");
  } catch (const tf2::TransformException& problem) {
    // After a start or a leap of the clock tf has not come yet; that is no news.
    if (following.failing.isZero()) following.failing = now;
    if ((now - following.failing).toSec() < tf_timeout_) return;
    report(body, following.in_sand ? BodyStatus::STALE : BodyStatus::WAITING, problem.what());
  }
}

void SandBodies::apply(Body& body, const Movement& movement) {
  if (movement.placed) simulator_.placeBody(body.number, *movement.placed);
  for (const Movement::Key& key : movement.keys) simulator_.appendPose(body.number, key.time, key.pose);
  if (movement.placed) body.following->pose = *movement.placed;
  if (!movement.keys.empty()) body.following->pose = movement.keys.back().pose;
  if (movement.late > 0.0 && movement.late < tf_timeout_) noteLate(body, movement.late);
  if (!movement.jump) return;
  ++body.status.jumps;
  if (!mayTell(body.following->told_jump, 5.0)) return;
  std::ostringstream story;
  story << " jumped " << movement.jump->distance << " m in " << movement.jump->duration << " s by tf frame "
        << body.following->frame.name << ", faster than ~max_body_speed " << max_body_speed_
        << " m/s; it is put there without a kick (jumps so far: " << body.status.jumps << ")";
  news_.add(BodyNews::Event::jumped, body.status, story.str());
}

void SandBodies::noteLate(const Body& body, double late) {
  late_.in_frame = true;
  if (late <= late_.most) return;
  late_.most = late;
  late_.frame = body.status.frame;
}

void SandBodies::tellLate(double duration) {
  if (!late_.in_frame) return;
  late_.in_frame = false;
  // That a busy machine holds tf up now and then is no news.
  if (++late_.count < 10 || !mayTell(late_.told, 60.0)) return;
  // Frames do not end whenever tf comes, but up to a frame earlier.
  ROS_WARN_STREAM("tf came too late to move bodies evenly, at worst "
                  << late_.most << " s, in frame " << late_.frame << "; expected a ~tf_delay of at least "
                  << tf_delay_ + late_.most + duration << " s (tf's period and latency), not " << tf_delay_
                  << " s");
  late_.count = 0;
  late_.most = 0.0;
}

void SandBodies::report(Body& body, std::uint8_t state, const std::string& problem) {
  BodyStatus& status = body.status;
  const bool news = state != status.state || status.problem.empty() != problem.empty();
  const std::string refusal = problem.empty() ? "" : transforms_.refusal(status.frame);
  status.state = state;
  status.problem = refusal.empty() ? problem : refusal;
  if (!news) return;
  if (problem.empty()) {
    news_.add(BodyNews::Event::in_sand, status, " is in the sand's frame " + sand_frame_);
  } else {
    news_.add(BodyNews::Event::lost, status,
              ": no pose from tf frame " + status.frame + " in the sand's frame " + sand_frame_ + ": " +
                  status.problem + "; " +
                  (state == BodyStatus::WAITING ? "it stays out of the sand until one comes"
                                                : "it rests where it was last seen"));
  }
}

void SandBodies::setFastest(double speed) {
  max_body_speed_ = speed;
  for (Body& body : bodies_) {
    if (body.following) body.following->track.setFastest(speed);
  }
}

std::vector<BodyStatus> SandBodies::status() const {
  std::vector<BodyStatus> all;
  for (const Body& body : bodies_) all.push_back(body.status);
  return all;
}

std::vector<ShownBody> SandBodies::shown() const {
  std::vector<ShownBody> shown;
  for (const Body& body : bodies_) {
    if (!body.appearance || (body.following && !body.following->in_sand)) continue;
    const Eigen::Isometry3d pose =
        body.following ? body.following->pose : body.motion.poseAt(simulator_.time());
    shown.push_back({body.status.name, pose, *body.appearance, body.box.sizes().maxCoeff()});
  }
  return shown;
}

}  // namespace shallow_sand
