#include "shallow_sand/rviz/pour_tool.h"

#include <rviz/display_context.h>
#include <rviz/load_resource.h>
#include <rviz/properties/float_property.h>
#include <rviz/render_panel.h>
#include <rviz/view_controller.h>
#include <rviz/viewport_mouse_event.h>

#include <pluginlib/class_list_macros.hpp>

#include "shallow_sand/PourSand.h"

namespace shallow_sand {
namespace {

constexpr float kPeriod = 0.05f;  // of messages while a button is held down [s]

}  // namespace

PourTool::PourTool() : rviz::Tool() {
  shortcut_key_ = 'd';
  radius_ =
      new rviz::FloatProperty("Radius", 0.1f, "Of the disc on which sand falls [m].", getPropertyContainer());
  radius_->setMin(0.001f);
  rate_ = new rviz::FloatProperty("Rate", 0.02f, "Sand that is poured or taken away [m3/s].",
                                  getPropertyContainer());
  rate_->setMin(0.0f);
}

void PourTool::onInitialize() {
  setName("Pour Sand");
  setCursor(rviz::getDefaultCursor());
  ring_ = std::make_unique<rviz::Shape>(rviz::Shape::Cylinder, scene_manager_);
  ring_->getRootNode()->setVisible(false);
}

void PourTool::activate() {
  setStatus(
      "Hold the left button down to pour sand, the right one to take it away. Wheel and middle button move "
      "the "
      "camera.");
}

void PourTool::deactivate() {
  direction_ = 0.0f;
  target_.reset();
  ring_->getRootNode()->setVisible(false);
}

int PourTool::processMouseEvent(rviz::ViewportMouseEvent& event) {
  direction_ = event.left() ? 1.0f : event.right() ? -1.0f : 0.0f;
  point(event);
  const bool moves_camera = event.middle() || event.wheel_delta != 0;
  if (moves_camera && event.panel->getViewController() != nullptr)
    event.panel->getViewController()->handleMouseEvent(event);
  return Render;
}

void PourTool::point(const rviz::ViewportMouseEvent& event) {
  target_ = sandUnderMouse(*context_, event);
  ring_->getRootNode()->setVisible(target_.has_value());
  if (!target_) return;
  const float across = 2.0f * radius_->getFloat();
  // rviz's cylinder stands along its z.
  ring_->setScale(Ogre::Vector3(across, across, 0.1f * across));
  ring_->setPosition(target_->place.in_scene);
  if (direction_ < 0.0f) {
    ring_->setColor(0.75f, 0.25f, 0.2f, 0.5f);
  } else {
    ring_->setColor(0.95f, 0.95f, 0.9f, 0.5f);
  }
}

void PourTool::update(float wall_dt, float /*ros_dt*/) {
  if (!target_ || target_->display.isNull() || direction_ == 0.0f) {
    waited_ = 0.0f;
    return;
  }
  waited_ += wall_dt;
  if (waited_ < kPeriod) return;
  publish(*target_->display, target_->place.in_map,
          static_cast<double>(direction_) * static_cast<double>(rate_->getFloat()) *
              static_cast<double>(waited_));
  waited_ = 0.0f;
}

void PourTool::publish(const HeightFieldDisplay& display, const Ogre::Vector3& place, double volume) {
  const std::string topic = display.nodeName() + "/pour";
  if (!publisher_ || publisher_.getTopic() != node_.resolveName(topic))
    publisher_ = node_.advertise<PourSand>(topic, 100);
  PourSand pour;
  pour.position.header.frame_id = display.mapFrame();
  pour.position.point.x = static_cast<double>(place.x);
  pour.position.point.y = static_cast<double>(place.y);
  pour.position.point.z = static_cast<double>(place.z);
  pour.radius = static_cast<double>(radius_->getFloat());
  pour.volume = volume;
  publisher_.publish(pour);
}

}  // namespace shallow_sand

PLUGINLIB_EXPORT_CLASS(shallow_sand::PourTool, rviz::Tool)
