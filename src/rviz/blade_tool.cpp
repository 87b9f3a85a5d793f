#include "shallow_sand/rviz/blade_tool.h"

#include <rviz/display_context.h>
#include <rviz/load_resource.h>
#include <rviz/properties/float_property.h>
#include <rviz/viewport_mouse_event.h>

#include <cmath>
#include <pluginlib/class_list_macros.hpp>

namespace shallow_sand {
namespace {

rviz::FloatProperty* length(const char* name, float value, const char* description, rviz::Property* parent) {
  auto* property = new rviz::FloatProperty(name, value, description, parent);
  property->setMin(0.001f);
  return property;
}

}  // namespace

BladeTool::BladeTool() : rviz::Tool() {
  shortcut_key_ = 'b';
  width_ = length("Width", 0.6f, "Of the blade, across the view [m].", getPropertyContainer());
  height_ = length("Height", 0.3f, "Of the blade [m].", getPropertyContainer());
  thickness_ = length("Thickness", 0.04f, "Of the blade [m].", getPropertyContainer());
  depth_ = new rviz::FloatProperty("Depth", 0.08f, "How deep it is put into the sand [m].",
                                   getPropertyContainer());
}

void BladeTool::onInitialize() {
  setName("Place Blade");
  setCursor(rviz::makeIconCursor("package://rviz/icons/crosshair.svg"));
}

void BladeTool::activate() { setStatus("Click on the sand to put a blade there."); }

int BladeTool::processMouseEvent(rviz::ViewportMouseEvent& event) {
  if (!event.leftDown()) return 0;
  const std::optional<SandUnderMouse> target = sandUnderMouse(*context_, event);
  if (!target) {
    setStatus("There is no sand under the mouse.");
    return 0;
  }
  if (answer_.valid()) {
    setStatus("Still waiting for the blade before.");
    return 0;
  }
  setStatus("The blade is on its way.");
  answer_ = answerLater([service = target->display->nodeName() + "/add_body", body = requestAt(*target)] {
    return askNode(service, body);
  });
  return Render;
}

AddBody BladeTool::requestAt(const SandUnderMouse& target) {
  AddBody body;
  AddBody::Request& request = body.request;
  // A name that no blade had before, in this rviz or another.
  request.name = "blade_" + std::to_string(ros::WallTime::now().toNSec() / 1000000);
  request.shape.type = shape_msgs::SolidPrimitive::BOX;
  request.shape.dimensions = {static_cast<double>(thickness_->getFloat()),
                              static_cast<double>(width_->getFloat()),
                              static_cast<double>(height_->getFloat())};
  request.pose.header.frame_id = target.display->mapFrame();
  const Ogre::Vector3& place = target.place.in_map;
  request.pose.pose.position.x = static_cast<double>(place.x);
  request.pose.pose.position.y = static_cast<double>(place.y);
  request.pose.pose.position.z =
      static_cast<double>(place.z + 0.5f * height_->getFloat() - depth_->getFloat());
  // Its x goes the way one looks.
  const double yaw =
      std::atan2(static_cast<double>(target.direction.y), static_cast<double>(target.direction.x));
  request.pose.pose.orientation.z = std::sin(0.5 * yaw);
  request.pose.pose.orientation.w = std::cos(0.5 * yaw);
  request.handle = true;
  return body;
}

void BladeTool::update(float /*wall_dt*/, float /*ros_dt*/) {
  if (!hasCome(answer_)) return;
  const NodeAnswer answer = answer_.get();
  setStatus(answer.success ? "The blade is in the sand; drag it by its handle."
                           : QString::fromStdString(answer.message));
}

}  // namespace shallow_sand

PLUGINLIB_EXPORT_CLASS(shallow_sand::BladeTool, rviz::Tool)
