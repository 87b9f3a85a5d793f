#pragma once

#include <OGRE/OgreVector3.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/time.h>

#include <deque>
#include <future>
#include <optional>
#include <string>

#include "shallow_sand/AddBody.h"
#include "shallow_sand/rviz/node_answer.h"

namespace shallow_sand {

/// A round stick that stands upright in the sand of a node, a body of that node. It goes from place to place,
/// straight and never faster than it may: where it cannot follow it comes later, but leaves nothing out.
class PaintingStick {
 public:
  struct Shape {
    double radius;  ///< [m]
    double length;  ///< [m]
  };
  /// Asks the node to add it.
  /// @param sand_node name of the node; `frame`: of its sand, in which places are
  /// @param tip where its lower end is first [m]
  PaintingStick(ros::NodeHandle node, const std::string& sand_node, const std::string& frame,
                const Shape& shape, const Ogre::Vector3& tip);

  const std::string& sandNode() const { return sand_node_; }
  /// What the node says of it, once.
  std::optional<NodeAnswer> news();
  /// Whether the node had it and has followed it no more for a second, as after a restart.
  bool isLost() const;
  /// Its tip goes there when it has been everywhere before. [m, m/s at most]
  void goTo(const Ogre::Vector3& tip, double speed);
  /// It stays there for a moment: the node looks at poses now and then, and would cut a corner in the air.
  void rest();
  /// To be called often: tells the node where the stick goes from now on.
  void advance(const ros::Time& now);
  /// The node takes it out, wherever it is. It is of no more use then.
  std::future<NodeAnswer> remove();

 private:
  struct Leg {
    Ogre::Vector3 to;
    double duration;  // at least [s]
  };
  const Ogre::Vector3& lastPlace() const { return way_.empty() ? tip_ : way_.back().to; }
  void publish(const ros::Time& stamp);

  std::string sand_node_;
  AddBody::Request body_;
  std::string frame_;
  ros::Publisher publisher_;
  std::future<NodeAnswer> adding_;
  ros::SteadyTime followed_;  // when the node did so for the last time, or said that it would; zero before
  Ogre::Vector3 tip_;         // at the time of the last pose
  std::deque<Leg> way_;       // of the tip, from there on
  ros::Time stamp_;           // of the last pose
  ros::Time advanced_;        // when it did so the last time
};

}  // namespace shallow_sand
