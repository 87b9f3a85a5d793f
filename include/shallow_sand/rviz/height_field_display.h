#pragma once

#ifndef Q_MOC_RUN
#include <rviz/display.h>

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "shallow_sand/client/height_field_subscriber.h"
#include "shallow_sand/rviz/height_field_visual.h"
#endif

namespace rviz {
class BoolProperty;
class ColorProperty;
class EnumProperty;
class FloatProperty;
class IntProperty;
class RosTopicProperty;
}  // namespace rviz

namespace Ogre {
class Ray;
}

namespace shallow_sand {

/// A place on the sand: in the map's frame, and in the scene's. [m]
struct SandPlace {
  Ogre::Vector3 in_map;
  Ogre::Vector3 in_scene;
};

/// rviz display `shallow_sand/HeightField`: follows the height field of a sand_node and draws it. Its
/// properties are in the README.
class HeightFieldDisplay : public rviz::Display {
  Q_OBJECT
 public:
  HeightFieldDisplay();
  ~HeightFieldDisplay() override;

  void setTopic(const QString& topic, const QString& datatype) override;
  void update(float wall_dt, float ros_dt) override;
  void reset() override;

  /// Name of the node whose sand is shown: the topic's up to its last slash.
  std::string nodeName() const;
  /// The sand that is shown; null as long as there is no map.
  const HeightField* field() const { return subscriber_ ? subscriber_->field() : nullptr; }
  /// tf frame of the sand; empty as long as there is no map.
  std::string mapFrame() const;
  /// A direction of the scene, in the map's frame.
  Ogre::Vector3 inMap(const Ogre::Vector3& direction) const { return orientation_.Inverse() * direction; }
  /// Where a ray of the scene meets the sand first.
  std::optional<SandPlace> meet(const Ogre::Ray& ray) const;

 protected:
  void onInitialize() override;
  void onEnable() override;
  void onDisable() override;
  void fixedFrameChanged() override;

 private Q_SLOTS:
  void subscribe();
  void changeColors();
  void changeColorBy();
  void changeRange();
  void changeContours();
  void changeShape();

 private:
  void unsubscribe();
  void take(const HeightField& map, const HeightFieldMap::Change& change);
  void startAnew(const HeightField& map);
  /// Low and high end of the colours' scale, from the map if so wished.
  std::pair<float, float> range(const HeightField& map) const;
  void showRange(const HeightField& map);
  void tellPace(float wall_dt);
  bool place();

  rviz::RosTopicProperty* topic_;
  rviz::EnumProperty* color_by_;
  rviz::ColorProperty* sand_color_;
  rviz::ColorProperty* bed_color_;
  rviz::BoolProperty* auto_range_;
  rviz::FloatProperty* low_;
  rviz::FloatProperty* high_;
  rviz::FloatProperty* contours_;
  rviz::FloatProperty* alpha_;
  rviz::BoolProperty* show_sand_;
  rviz::BoolProperty* sides_;
  rviz::IntProperty* most_triangles_;

  std::unique_ptr<HeightFieldVisual> visual_;
  std::unique_ptr<HeightFieldSubscriber> subscriber_;
  std::vector<float> start_;   // elevations when the map came first [m]
  std::uint64_t started_ = 0;  // number of that map
  Ogre::Vector3 position_{Ogre::Vector3::ZERO};
  Ogre::Quaternion orientation_{Ogre::Quaternion::IDENTITY};
  bool changed_ = false;  // something was taken that is not shown yet
  float told_ = 0.0f;     // time since the pace was told [s]
  int shown_since_told_ = 0;
  double age_since_told_ = 0.0;  // summed [s]
};

}  // namespace shallow_sand
