#pragma once

#ifndef Q_MOC_RUN
#include <ros/node_handle.h>
#include <rviz/tool.h>

#include <future>
#include <memory>
#include <optional>

#include "shallow_sand/rviz/painting_stick.h"
#include "shallow_sand/rviz/sand_under_mouse.h"
#endif

namespace rviz {
class FloatProperty;
}

namespace shallow_sand {

/// rviz tool `shallow_sand/PaintSand`: while the left button is held down a round stick goes through the sand
/// under the mouse, straight from one place to the next. It is above the sand between strokes, and is taken
/// away with the tool.
class PaintTool : public rviz::Tool {
  Q_OBJECT
 public:
  PaintTool();
  ~PaintTool() override;

  void activate() override;
  void deactivate() override { putStickAway(); }
  void update(float wall_dt, float ros_dt) override;
  int processMouseEvent(rviz::ViewportMouseEvent& event) override;

 protected:
  void onInitialize() override;

 private Q_SLOTS:
  void putStickAway();

 private:
  struct Stroke {
    QPointer<HeightFieldDisplay> display;
    /// As it was when the stroke began: the groove behind the stick does not count.
    HeightField sand;
    float lifted;       ///< elevation of the tip above all of that sand [m]
    Ogre::Vector3 tip;  ///< the last place to go to [m]
  };
  void begin(const SandUnderMouse& target);
  void takeStick(const HeightFieldDisplay& display, const Ogre::Vector3& tip);
  void goOn(const SandUnderMouse& target);
  void goTo(const Ogre::Vector3& tip);
  void end();

  rviz::FloatProperty* radius_;
  rviz::FloatProperty* depth_;
  rviz::FloatProperty* speed_;
  ros::NodeHandle node_;
  std::unique_ptr<PaintingStick> stick_;
  std::optional<Stroke> stroke_;
  std::future<NodeAnswer> removing_;
};

}  // namespace shallow_sand
