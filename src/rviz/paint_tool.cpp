#include "shallow_sand/rviz/paint_tool.h"

#include <rviz/load_resource.h>
#include <rviz/properties/float_property.h>
#include <rviz/render_panel.h>
#include <rviz/view_controller.h>
#include <rviz/viewport_mouse_event.h>

#include <algorithm>
#include <chrono>
#include <pluginlib/class_list_macros.hpp>

#include "shallow_sand/rviz/sand_ray.h"
#include "shallow_sand/rviz/sand_vertices.h"

namespace shallow_sand {
namespace {

float highestGround(const HeightField& map) {
  float highest = groundElevation(map, 0);
  for (std::size_t cell = 1; cell < map.depth.size(); ++cell)
    highest = std::max(highest, groundElevation(map, cell));
  return highest;
}

/// Of any button. The second of two strokes that begin quickly one after the other is a double click.
bool isPress(const rviz::ViewportMouseEvent& event) {
  return event.type == QEvent::MouseButtonPress || event.type == QEvent::MouseButtonDblClick;
}

}  // namespace

PaintTool::PaintTool() : rviz::Tool() {
  shortcut_key_ = 'w';
  radius_ = new rviz::FloatProperty("Radius", 0.05f, "Of the stick [m].", getPropertyContainer(),
                                    SLOT(putStickAway()), this);
  radius_->setMin(0.001f);
  depth_ = new rviz::FloatProperty("Depth", 0.02f, "How deep it goes below the surface [m].",
                                   getPropertyContainer(), SLOT(putStickAway()), this);
  depth_->setMin(0.0f);
  speed_ = new rviz::FloatProperty("Speed", 2.0f, "At which it follows a mouse that is faster [m/s].",
                                   getPropertyContainer());
  speed_->setMin(0.001f);
}

PaintTool::~PaintTool() {
  putStickAway();
  // rviz may end now, and with it what has not been sent.
  if (removing_.valid()) removing_.wait_for(std::chrono::seconds(1));
}

void PaintTool::onInitialize() {
  setName("Paint Sand");
  setCursor(rviz::makeIconCursor("package://rviz/icons/crosshair.svg"));
}

void PaintTool::activate() {
  setStatus("Hold the left button down to paint. Wheel, middle and right button move the camera.");
}

int PaintTool::processMouseEvent(rviz::ViewportMouseEvent& event) {
  if (event.left()) {
    const std::optional<SandUnderMouse> target = sandUnderMouse(*context_, event);
    if (!target) {
      setStatus("There is no sand under the mouse.");
    } else if (isPress(event)) {
      begin(*target);
    } else if (stroke_) {
      goOn(*target);
    }
    return Render;
  }
  end();
  const bool moves_camera = event.middle() || event.right() || event.wheel_delta != 0;
  if (moves_camera && event.panel->getViewController() != nullptr)
    event.panel->getViewController()->handleMouseEvent(event);
  return Render;
}

void PaintTool::begin(const SandUnderMouse& target) {
  const HeightField& sand = *target.display->field();
  const float lifted = highestGround(sand) + 2.0f * radius_->getFloat();
  const Ogre::Vector3& place = target.place.in_map;
  takeStick(*target.display, {place.x, place.y, lifted});
  stroke_ = Stroke{target.display, sand, lifted, {place.x, place.y, lifted}};
  goTo(stroke_->tip);
  goOn(target);
  stick_->rest();
}

void PaintTool::takeStick(const HeightFieldDisplay& display, const Ogre::Vector3& tip) {
  if (stick_ && (stick_->isLost() || stick_->sandNode() != display.nodeName())) putStickAway();
  if (stick_) return;
  setStatus("The stick is on its way.");
  const auto radius = static_cast<double>(radius_->getFloat());
  // Its upper end is never below the surface.
  const PaintingStick::Shape shape{radius, 6.0 * radius + static_cast<double>(depth_->getFloat())};
  stick_ = std::make_unique<PaintingStick>(node_, display.nodeName(), display.mapFrame(), shape, tip);
}

void PaintTool::goOn(const SandUnderMouse& target) {
  if (target.display != stroke_->display) return;
  const Ogre::Vector3& place = target.place.in_map;
  const float surface = elevationAt(stroke_->sand, place.x, place.y);
  stroke_->tip = {place.x, place.y, surface - depth_->getFloat()};
  goTo(stroke_->tip);
}

void PaintTool::goTo(const Ogre::Vector3& tip) { stick_->goTo(tip, static_cast<double>(speed_->getFloat())); }

void PaintTool::end() {
  if (!stroke_) return;
  stick_->rest();
  goTo({stroke_->tip.x, stroke_->tip.y, stroke_->lifted});
  stroke_.reset();
}

void PaintTool::update(float /*wall_dt*/, float /*ros_dt*/) {
  if (!stick_) return;
  if (const std::optional<NodeAnswer> news = stick_->news()) {
    setStatus(news->success ? "The stick paints where the left button is held down."
                            : QString::fromStdString(news->message));
    if (!news->success) {
      stroke_.reset();
      stick_.reset();
      return;
    }
  }
  stick_->advance(ros::Time::now());
}

void PaintTool::putStickAway() {
  stroke_.reset();
  if (!stick_) return;
  removing_ = stick_->remove();
  stick_.reset();
}

}  // namespace shallow_sand

PLUGINLIB_EXPORT_CLASS(shallow_sand::PaintTool, rviz::Tool)
