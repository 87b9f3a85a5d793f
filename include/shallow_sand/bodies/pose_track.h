#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <optional>
#include <vector>

namespace shallow_sand {

/// How far the corner of a box that goes farthest goes from one pose to another. [m]
double farthestMove(const Eigen::AlignedBox3d& box, const Eigen::Isometry3d& from,
                    const Eigen::Isometry3d& to);

/// The stretch (start, end] of the clock of poses that one frame of the sand covers. [s]
struct FrameTimes {
  double start;
  double end;
  double simulated_end;  ///< the simulated time at `end`

  double simulated(double time) const { return simulated_end - (end - time); }
};

/// Where a body goes within one frame.
struct Movement {
  struct Key {
    double time;  ///< simulated [s]
    Eigen::Isometry3d pose;
  };
  struct Jump {
    double distance;  ///< of the body's farthest point [m]
    double duration;  ///< in which it went there [s]
  };
  std::optional<Eigen::Isometry3d> placed;  ///< put there when the frame begins, without a kick
  std::vector<Key> keys;                    ///< then moved through these
  std::optional<Jump> jump;
  double late = 0.0;  ///< by how much poses came too late to move the body before this frame [s]
};

/// Lets a body follow poses that arrive with delay, unevenly or not at all, at no other speed than the one
/// the poses themselves have:
/// - within a frame the body goes where the source has it at the same times, so it does not matter how the
///   source's rate and the frames' rate relate;
/// - it is never moved beyond the newest pose, where it waits for the next;
/// - where it waited, or where frames left out a stretch of time, it does not race after the poses but is put
///   where it should be when the frame begins;
/// - where poses move faster than a limit they have jumped: it is put at the newest.
class PoseTrack {
 public:
  /// Pose of the body in the grid's frame at a time up to the newest [s]; may throw.
  using PoseSource = std::function<Eigen::Isometry3d(double time)>;

  /// @param box around the body, in its frame [m]
  /// @param fastest speed of any of its corners that is taken for motion [m/s]
  PoseTrack(const Eigen::AlignedBox3d& box, double fastest) : box_(box), fastest_(fastest) {}

  /// @param frame not before the last one
  /// @param newest time of the newest pose [s]; infinite if it holds for ever
  /// What `poseAt` throws comes through, and leaves the track as it was.
  Movement follow(const FrameTimes& frame, double newest, const PoseSource& poseAt);

  void setFastest(double fastest) { fastest_ = fastest; }  ///< see above
  /// The clock starts anew: the body is put at its next pose.
  void restart() { reached_.reset(); }

 private:
  struct Place {
    double time;  ///< of the source
    Eigen::Isometry3d pose;
  };
  void enter(const FrameTimes& frame, double newest, const PoseSource& poseAt, Movement& movement);
  void move(const FrameTimes& frame, double newest, const PoseSource& poseAt, Movement& movement);
  std::optional<Movement::Jump> jumpTo(const Place& place) const;

  Eigen::AlignedBox3d box_;
  double fastest_;
  std::optional<Place> reached_;  ///< the last pose taken
  double told_until_ = 0.0;       ///< the last time for which the simulator knows the pose [s]
  double late_ = 0.0;             ///< by how much the frame before ended beyond the newest pose [s]
};

}  // namespace shallow_sand
