#pragma once

#ifndef Q_MOC_RUN
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <rviz/ogre_helpers/shape.h>
#include <rviz/tool.h>

#include <memory>
#include <optional>
#include <string>

#include "shallow_sand/rviz/sand_under_mouse.h"
#endif

namespace rviz {
class FloatProperty;
}

namespace shallow_sand {

/// rviz tool `shallow_sand/PourSand`: sand falls where the left button is held down, and is taken away with
/// the right one.
class PourTool : public rviz::Tool {
  Q_OBJECT
 public:
  PourTool();

  void activate() override;
  void deactivate() override;
  void update(float wall_dt, float ros_dt) override;
  int processMouseEvent(rviz::ViewportMouseEvent& event) override;

 protected:
  void onInitialize() override;

 private:
  void point(const rviz::ViewportMouseEvent& event);
  void publish(const HeightFieldDisplay& display, const Ogre::Vector3& place, double volume);

  rviz::FloatProperty* radius_;
  rviz::FloatProperty* rate_;
  ros::NodeHandle node_;
  ros::Publisher publisher_;
  std::unique_ptr<rviz::Shape> ring_;  // shows the disc on which sand falls
  std::optional<SandUnderMouse> target_;
  float direction_ = 0.0f;  // 1: pours, -1: takes away, 0: neither
  float waited_ = 0.0f;     // since sand was poured the last time [s]
};

}  // namespace shallow_sand
