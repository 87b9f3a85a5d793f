#pragma once

#ifndef Q_MOC_RUN
#include <ros/node_handle.h>
#include <rviz/tool.h>

#include <future>

#include "shallow_sand/AddBody.h"
#include "shallow_sand/rviz/node_answer.h"
#include "shallow_sand/rviz/sand_under_mouse.h"
#endif

namespace rviz {
class FloatProperty;
}

namespace shallow_sand {

/// rviz tool `shallow_sand/PlaceBlade`: a click puts a blade into the sand, across the view. It comes with a
/// handle to drag it by, which an InteractiveMarkers display shows.
class BladeTool : public rviz::Tool {
  Q_OBJECT
 public:
  BladeTool();

  void activate() override;
  void deactivate() override {}
  void update(float wall_dt, float ros_dt) override;
  int processMouseEvent(rviz::ViewportMouseEvent& event) override;

 protected:
  void onInitialize() override;

 private:
  AddBody requestAt(const SandUnderMouse& target);

  rviz::FloatProperty* width_;
  rviz::FloatProperty* height_;
  rviz::FloatProperty* thickness_;
  rviz::FloatProperty* depth_;
  ros::NodeHandle node_;
  std::future<NodeAnswer> answer_;  // of the call that is under way
};

}  // namespace shallow_sand
