#pragma once

#include <ros/time.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "shallow_sand/BodyStatus.h"
#include "shallow_sand/bodies/distance_field.h"
#include "shallow_sand/bodies/motion.h"
#include "shallow_sand/bodies/pose_track.h"
#include "shallow_sand/ros/body_look.h"
#include "shallow_sand/ros/body_news.h"
#include "shallow_sand/ros/frame_clock.h"
#include "shallow_sand/ros/node_parameters.h"
#include "shallow_sand/ros/transform_reader.h"
#include "shallow_sand/sim/simulator.h"

namespace shallow_sand {

/// What moves a body that follows tf.
struct TfFrame {
  std::string name;
  Eigen::Isometry3d offset = Eigen::Isometry3d::Identity();  ///< of the body in that frame
};

/// What is shown of a body.
struct BodyAppearance {
  visualization_msgs::Marker look;  ///< see lookOf
  bool handle = false;              ///< offers itself to be dragged
};

/// A body that is shown, where it is.
struct ShownBody {
  std::string name;
  Eigen::Isometry3d pose;  ///< in the sand's frame, at the time of the sand
  BodyAppearance appearance;
  double size;  ///< of its box's longest side [m]
};

/// All bodies of a simulator by name: those of the scene, robots' links, and those that services add. Takes
/// poses of those that follow tf. A body whose pose cannot be had rests where it was last seen, or stays out
/// of the sand; the log tells of every change once.
class SandBodies {
 public:
  /// @param clock of the sand
  /// @param simulator built from the scene of `parameters`, so that its bodies are there. Simulator,
  /// transforms and clock must outlive this.
  SandBodies(const NodeParameters& parameters, const FrameClock& clock, const TransformReader& transforms,
             Simulator& simulator);

  bool has(const std::string& name) const;
  /// @throws InvalidParameter if the name is taken or empty; so do the next two
  void requireFree(const std::string& name) const;
  /// Adds a body that follows tf. @param robot whose link it is; empty: none
  void addFollowing(const std::string& name, const std::string& robot, const TfFrame& frame,
                    std::shared_ptr<const DistanceField> field,
                    std::optional<BodyAppearance> appearance = {});
  /// Adds a body that rests at a pose in the sand's frame.
  void addPlaced(const std::string& name, const Eigen::Isometry3d& pose,
                 std::shared_ptr<const DistanceField> field, const BodyAppearance& appearance);
  /// @throws InvalidParameter if there is no such body
  void remove(const std::string& name);
  /// Moves a body that follows no tf frame to a pose in the sand's frame within a duration [s, simulated];
  /// 0: puts it there. @throws InvalidParameter if there is no such body, it follows tf, or would be too fast
  void move(const std::string& name, const Eigen::Isometry3d& pose, double duration);
  /// How long a body takes at least to get to a pose [s]. @throws InvalidParameter if there is no such body
  double leastDuration(const std::string& name, const Eigen::Isometry3d& pose) const;
  /// Where tf has a frame at the time of the sand, in the sand's; where it has it last, if it does not know
  /// that time; the identity if it has no name. @throws tf2::TransformException
  Eigen::Isometry3d poseOf(const std::string& frame) const;

  /// Tells the simulator where bodies go in the frame that ends at ROS time `end` and simulated time
  /// `simulated_end` [s], and that is `duration` [s] long.
  void update(const ros::Time& end, double duration, double simulated_end);
  /// To be called when ROS time went backwards, or frames of the sand do not go on where the last one ended:
  /// bodies that follow tf are put at their next poses.
  void restartClock();
  /// Whether tf has come up to a time for all bodies that follow it and move.
  bool posesHaveCome(const ros::Time& time) const;

  /// Has the sand go on from `snapshot`. Bodies of the scene are then where the scene has them at its time,
  /// all others stay where they are. @throws InvalidParameter if it does not fit; nothing changes then
  void restore(const Snapshot& snapshot);

  /// ~max_body_speed from now on. [m/s]
  void setFastest(double speed);

  std::vector<BodyStatus> status() const;
  /// Those of the scene and those that services have added, as soon as they have a pose; not robots' links.
  std::vector<ShownBody> shown() const;

 private:
  struct Following {
    TfFrame frame;
    PoseTrack track;
    ros::Time failing;        ///< since when its pose cannot be had; zero: it can
    bool in_sand = false;     ///< it has had a pose
    ros::WallTime told_jump;  ///< when the log last told of a jump
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< that it had last, if it is in the sand
  };
  struct Body {
    std::size_t number;  ///< of the simulator
    Eigen::AlignedBox3d box;
    std::optional<Following> following;
    Motion motion;                  ///< of a body that follows no frame; simulated time
    std::vector<PoseKey> of_scene;  ///< that the scene gave it; none for other bodies
    bool strayed = false;           ///< from what the scene gave it
    BodyStatus status;
    std::optional<BodyAppearance> appearance;  ///< none: it is not shown
  };
  Body& add(const std::string& name, const std::shared_ptr<const DistanceField>& field);
  std::size_t indexOf(const std::string& name) const;
  void follow(Body& body, const FrameTimes& times, const ros::Time& now);
  /// Puts a body where it rests or, of the scene, goes on from the present simulated time on.
  void placeAnew(Body& body, const Eigen::Isometry3d& rest);
  void apply(Body& body, const Movement& movement);
  void noteLate(const Body& body, double late);
  /// @param duration of this frame [s]
  void tellLate(double duration);
  void report(Body& body, std::uint8_t state, const std::string& problem);
  Eigen::Isometry3d lookUp(const TfFrame& frame, const ros::Time& time) const;

  std::string sand_frame_;
  double tf_delay_;
  double tf_timeout_;
  double max_body_speed_;
  const FrameClock& clock_;
  const TransformReader& transforms_;
  Simulator& simulator_;
  std::vector<Body> bodies_;
  ros::Time origin_;  ///< of the times given to tracks: as seconds since 1970 they would be too coarse
  ros::Time last_end_;
  ros::Time leapt_;  ///< when time last went on by more than ~tf_timeout from one frame to the next
  BodyNews news_;
  struct {
    double most = 0.0;      ///< [s]
    std::string frame;      ///< of tf, that was that late
    int count = 0;          ///< frames of the sand in which poses were too late
    bool in_frame = false;  ///< this one is among them
    ros::WallTime told;
  } late_;  ///< since it was told last
};

}  // namespace shallow_sand
