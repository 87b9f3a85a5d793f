#include "shallow_sand/rviz/height_field_display.h"

#include <OGRE/OgreRay.h>
#include <OGRE/OgreRenderSystem.h>
#include <OGRE/OgreRoot.h>
#include <ros/message_traits.h>
#include <rviz/display_context.h>
#include <rviz/frame_manager.h>
#include <rviz/properties/bool_property.h>
#include <rviz/properties/color_property.h>
#include <rviz/properties/enum_property.h>
#include <rviz/properties/float_property.h>
#include <rviz/properties/int_property.h>
#include <rviz/properties/ros_topic_property.h>

#include <algorithm>
#include <cmath>
#include <pluginlib/class_list_macros.hpp>

#include "shallow_sand/rviz/sand_ray.h"

namespace shallow_sand {
namespace {

constexpr float kPaceIsToldEvery = 1.0f;  // [s]

ColorBy colorBy(rviz::EnumProperty& property) { return static_cast<ColorBy>(property.getOptionInt()); }

ShownValue::Kind valueOf(ColorBy what) {
  if (what == ColorBy::speed) return ShownValue::Kind::speed;
  return what == ColorBy::change ? ShownValue::Kind::rise : ShownValue::Kind::none;
}

/// Whether the processor draws: Mesa's drivers without a graphics card.
bool isDrawnInSoftware() {
  const std::string name = Ogre::Root::getSingleton().getRenderSystem()->getCapabilities()->getDeviceName();
  return name.find("llvmpipe") != std::string::npos || name.find("softpipe") != std::string::npos ||
         name.find("Software Rasterizer") != std::string::npos;
}

std::size_t mostTriangles(int chosen) {
  if (chosen > 0) return static_cast<std::size_t>(chosen);
  return isDrawnInSoftware() ? 100000 : 4000000;
}

std::vector<float> elevationsOf(const HeightField& map) {
  std::vector<float> elevations(map.depth.size());
  for (std::size_t k = 0; k < elevations.size(); ++k) elevations[k] = groundElevation(map, k);
  return elevations;
}

}  // namespace

HeightFieldDisplay::HeightFieldDisplay() {
  topic_ = new rviz::RosTopicProperty(
      "Topic", "", QString::fromStdString(ros::message_traits::datatype<HeightField>()),
      "Height field of a sand_node, such as /sand_node/height_field.", this, SLOT(subscribe()));
  color_by_ = new rviz::EnumProperty("Color By", "Sand", "What the colour of the sand tells.", this,
                                     SLOT(changeColorBy()));
  color_by_->addOption("Sand", static_cast<int>(ColorBy::sand));
  color_by_->addOption("Elevation", static_cast<int>(ColorBy::elevation));
  color_by_->addOption("Depth", static_cast<int>(ColorBy::depth));
  color_by_->addOption("Slope", static_cast<int>(ColorBy::slope));
  color_by_->addOption("Speed", static_cast<int>(ColorBy::speed));
  color_by_->addOption("Change", static_cast<int>(ColorBy::change));
  sand_color_ = new rviz::ColorProperty("Sand Color", QColor(222, 186, 134), "Of sand, coloured by Sand.",
                                        this, SLOT(changeColors()));
  bed_color_ = new rviz::ColorProperty("Bed Color", QColor(120, 118, 116),
                                       "Of the bed where it is bare: where sand is "
                                       "thinner than a tenth of a cell.",
                                       this, SLOT(changeColors()));
  auto_range_ =
      new rviz::BoolProperty("Autocompute Range", true,
                             "Whether the scale of colours goes from the map's lowest value to its highest.",
                             this, SLOT(changeRange()));
  low_ = new rviz::FloatProperty("Min Value", 0.0f, "First colour of the scale [m, m/s or degrees].", this,
                                 SLOT(changeRange()));
  high_ = new rviz::FloatProperty("Max Value", 1.0f, "Last colour of the scale [m, m/s or degrees].", this,
                                  SLOT(changeRange()));
  contours_ = new rviz::FloatProperty(
      "Contour Interval", 0.0f,
      "Distance of contour lines in elevation [m], the first half of it above 0; 0: none.", this,
      SLOT(changeContours()));
  contours_->setMin(0.0f);
  alpha_ =
      new rviz::FloatProperty("Alpha", 1.0f, "1: opaque; less: one sees through.", this, SLOT(changeShape()));
  alpha_->setMin(0.0f);
  alpha_->setMax(1.0f);
  show_sand_ = new rviz::BoolProperty(
      "Show Sand", true, "Off: only the bed below, for instance where grains stand for the sand.", this,
      SLOT(changeShape()));
  sides_ = new rviz::BoolProperty("Show Sides", true,
                                  "Whether the cut through the sand along the map's sides is drawn.", this,
                                  SLOT(changeShape()));
  most_triangles_ = new rviz::IntProperty("Max Triangles", 0,
                                          "A map with more is drawn with every second, third ... cell. 0: 4 "
                                          "million, or 100 000 where the processor "
                                          "draws instead of a graphics card.",
                                          this, SLOT(changeShape()));
  most_triangles_->setMin(0);
}

HeightFieldDisplay::~HeightFieldDisplay() = default;

void HeightFieldDisplay::onInitialize() {
  try {
    visual_ = std::make_unique<HeightFieldVisual>(scene_manager_, scene_node_);
  } catch (const std::exception& error) {
    setStatus(rviz::StatusProperty::Error, "Graphics", error.what());
    return;
  }
  changeColors();
  changeColorBy();
  changeContours();
  changeShape();
}

void HeightFieldDisplay::setTopic(const QString& topic, const QString& /*datatype*/) {
  topic_->setString(topic);
}

void HeightFieldDisplay::onEnable() { subscribe(); }
void HeightFieldDisplay::onDisable() { unsubscribe(); }
void HeightFieldDisplay::fixedFrameChanged() { place(); }

void HeightFieldDisplay::reset() {
  Display::reset();
  start_.clear();
  subscribe();
}

void HeightFieldDisplay::unsubscribe() {
  subscriber_.reset();
  if (visual_) visual_->clear();
  deleteStatus("Updates");
}

void HeightFieldDisplay::subscribe() {
  unsubscribe();
  if (!isEnabled() || !visual_) return;
  if (topic_->getTopicStd().empty()) {
    setStatus(rviz::StatusProperty::Warn, "Topic",
              "none is set; expected that of a sand_node's height field");
    return;
  }
  setStatus(rviz::StatusProperty::Warn, "Topic", "no map has come yet");
  try {
    subscriber_ = std::make_unique<HeightFieldSubscriber>(
        update_nh_, topic_->getTopicStd(),
        [this](const HeightField& map, const HeightFieldMap::Change& change) { take(map, change); });
  } catch (const ros::Exception& error) {
    setStatus(rviz::StatusProperty::Error, "Topic", error.what());
  }
}

void HeightFieldDisplay::take(const HeightField& map, const HeightFieldMap::Change& change) {
  if (change.made_anew) startAnew(map);
  for (const CellRectangle& cells : change.cells) visual_->touch(cells);
  changed_ = true;
}

void HeightFieldDisplay::startAnew(const HeightField& map) {
  setStatus(rviz::StatusProperty::Ok, "Topic",
            QString("%1 x %2 cells of %3 m").arg(map.columns).arg(map.rows).arg(map.spacing));
  // A map that is the same but for some updates that got lost goes on from the same start.
  if (start_.size() != map.depth.size() || started_ != map.map) {
    start_ = elevationsOf(map);
    started_ = map.map;
  }
  visual_->reset(map);
  changeShape();
  changeColorBy();
}

void HeightFieldDisplay::update(float wall_dt, float /*ros_dt*/) {
  const HeightField* map = field();
  if (visual_ && map != nullptr && place() && changed_) {
    changed_ = false;
    showRange(*map);
    visual_->write(*map, {valueOf(colorBy(*color_by_)), &start_});
    shown_since_told_ += 1;
    age_since_told_ += (ros::Time::now() - map->header.stamp).toSec();
    context_->queueRender();
  }
  tellPace(wall_dt);
}

void HeightFieldDisplay::tellPace(float wall_dt) {
  told_ += wall_dt;
  if (told_ < kPaceIsToldEvery) return;
  if (shown_since_told_ > 0) {
    setStatus(rviz::StatusProperty::Ok, "Updates",
              QString("%1 a second; what they show is %2 s old")
                  .arg(static_cast<double>(shown_since_told_) / static_cast<double>(told_), 0, 'f', 1)
                  .arg(age_since_told_ / shown_since_told_, 0, 'f', 2));
  } else {
    deleteStatus("Updates");
  }
  told_ = 0.0f;
  shown_since_told_ = 0;
  age_since_told_ = 0.0;
}

bool HeightFieldDisplay::place() {
  if (mapFrame().empty()) return false;
  const bool found =
      context_->getFrameManager()->getTransform(mapFrame(), ros::Time(), position_, orientation_);
  if (found) {
    setStatus(rviz::StatusProperty::Ok, "Transform", "found");
    visual_->setPose(position_, orientation_);
  } else {
    setStatus(rviz::StatusProperty::Error, "Transform",
              QString("no transform from %1 to the fixed frame %2")
                  .arg(QString::fromStdString(mapFrame()), fixed_frame_));
  }
  return found;
}

std::pair<float, float> HeightFieldDisplay::range(const HeightField& map) const {
  const ColorBy what = colorBy(*color_by_);
  if (!auto_range_->getBool()) {
    const auto end = [&](const rviz::FloatProperty& property) {
      const float value = property.getFloat();
      return what == ColorBy::slope ? std::tan(value * static_cast<float>(M_PI) / 180.0f) : value;
    };
    return {end(*low_), end(*high_)};
  }
  const auto value = [&](std::size_t cell) {
    if (what == ColorBy::depth) return map.depth[cell];
    if (what == ColorBy::speed) return map.speed.empty() ? 0.0f : map.speed[cell];
    if (what == ColorBy::change) return groundElevation(map, cell) - start_[cell];
    return groundElevation(map, cell);
  };
  if (what == ColorBy::slope) return {0.0f, 1.0f};  // 45°: nothing but steps is steeper
  float low = value(0);
  float high = low;
  for (std::size_t cell = 1; cell < map.depth.size(); ++cell) {
    low = std::min(low, value(cell));
    high = std::max(high, value(cell));
  }
  if (what == ColorBy::depth || what == ColorBy::speed) low = 0.0f;
  if (what == ColorBy::change) {
    high = std::max({high, -low, map.spacing});
    low = -high;
  }
  return {low, high};
}

void HeightFieldDisplay::showRange(const HeightField& map) {
  const ColorBy what = colorBy(*color_by_);
  if (what == ColorBy::sand) return;
  const auto [low, high] = range(map);
  visual_->material().setColorBy(what, low, high);
}

void HeightFieldDisplay::changeColors() {
  if (!visual_) return;
  visual_->material().setColors(sand_color_->getOgreColor(), bed_color_->getOgreColor());
  context_->queueRender();
}

void HeightFieldDisplay::changeColorBy() {
  if (!visual_) return;
  const ColorBy what = colorBy(*color_by_);
  auto_range_->setHidden(what == ColorBy::sand);
  visual_->material().setColorBy(what, low_->getFloat(), high_->getFloat());
  changeRange();
  const HeightField* map = field();
  if (map == nullptr) return;
  if (what == ColorBy::speed && map->speed.empty()) {
    setStatus(rviz::StatusProperty::Warn, "Color By", "the node publishes no speed: set its ~publish_speed");
  } else {
    deleteStatus("Color By");
  }
  visual_->touchAll(*map);
}

void HeightFieldDisplay::changeRange() {
  low_->setHidden(auto_range_->getBool());
  high_->setHidden(auto_range_->getBool());
  changed_ = true;
}

void HeightFieldDisplay::changeContours() {
  if (!visual_) return;
  visual_->material().setContourInterval(contours_->getFloat());
  context_->queueRender();
}

void HeightFieldDisplay::changeShape() {
  if (!visual_) return;
  visual_->material().setAlpha(alpha_->getFloat());
  visual_->material().showSand(show_sand_->getBool());
  visual_->showSides(sides_->getBool());
  const HeightField* map = field();
  if (map != nullptr) visual_->setMostTriangles(*map, mostTriangles(most_triangles_->getInt()));
  context_->queueRender();
}

std::string HeightFieldDisplay::nodeName() const {
  const std::string topic = topic_->getTopicStd();
  return topic.substr(0, topic.rfind('/'));
}

std::string HeightFieldDisplay::mapFrame() const {
  const HeightField* map = field();
  return map == nullptr ? std::string() : map->header.frame_id;
}

std::optional<SandPlace> HeightFieldDisplay::meet(const Ogre::Ray& ray) const {
  const HeightField* map = field();
  if (map == nullptr) return std::nullopt;
  const Ogre::Quaternion to_map = orientation_.Inverse();
  const Ogre::Ray in_map(to_map * (ray.getOrigin() - position_), to_map * ray.getDirection());
  const std::optional<float> distance = meetSand(*map, in_map);
  if (!distance) return std::nullopt;
  return SandPlace{in_map.getPoint(*distance), ray.getPoint(*distance)};
}

}  // namespace shallow_sand

PLUGINLIB_EXPORT_CLASS(shallow_sand::HeightFieldDisplay, rviz::Display)
