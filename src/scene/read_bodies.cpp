#include <algorithm>

#include "bounds.h"
#include "scene_reader.h"

namespace shallow_sand {
namespace {

Cylinder readCylinder(const SceneValue& value) {
  value.requireMap({"radius", "length"});
  return {value.at("radius").number(bounds::positive), value.at("length").number(bounds::positive)};
}

Shape readShape(const SceneValue& value) {
  if (const auto mesh = value.find("mesh")) {
    mesh->fail("mesh", "box, cylinder or sphere (meshes are not available yet)");
  }
  const std::string kind = value.requireOneOf({"box", "cylinder", "sphere"});
  const SceneValue shape = value.at(kind);
  if (kind == "box") {
    return Box{shape.vector<3>(bounds::positive)};
  }
  if (kind == "cylinder") {
    return readCylinder(shape);
  }
  return Sphere{shape.number(bounds::positive)};
}

/// Roll, pitch and yaw about the fixed axes x, y and z, in this order, as in URDF. [rad]
Eigen::Quaterniond rotationFrom(const Eigen::Vector3d& roll_pitch_yaw) {
  return Eigen::AngleAxisd(roll_pitch_yaw.z(), Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(roll_pitch_yaw.y(), Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(roll_pitch_yaw.x(), Eigen::Vector3d::UnitX());
}

PoseKey readPoseKey(const SceneValue& value) {
  value.requireMap({"time", "position", "rpy"});
  Eigen::Vector3d degrees = Eigen::Vector3d::Zero();
  value.read("rpy", bounds::finite, degrees);
  PoseKey key;
  key.time = value.at("time").number(bounds::finite);
  key.pose.translation() = value.at("position").vector<3>(bounds::finite);
  key.pose.linear() = rotationFrom(degrees.unaryExpr(&radians)).toRotationMatrix();
  return key;
}

std::vector<PoseKey> readMotion(const SceneValue& value) {
  std::vector<PoseKey> motion;
  for (const SceneValue& item : value.items()) {
    const PoseKey key = readPoseKey(item);
    if (!motion.empty() && key.time <= motion.back().time) {
      item.at("time").fail("a time after that of the pose before");
    }
    motion.push_back(key);
  }
  if (motion.empty()) {
    value.fail("at least one pose");
  }
  return motion;
}

SceneBody readBody(const SceneValue& value) {
  value.requireMap({"name", "shape", "motion"});
  return {value.at("name").text(), readShape(value.at("shape")), readMotion(value.at("motion"))};
}

}  // namespace

std::vector<SceneBody> readBodies(const SceneValue& root) {
  std::vector<SceneBody> bodies;
  if (const auto list = root.find("bodies")) {
    for (const SceneValue& value : list->items()) {
      SceneBody body = readBody(value);
      const bool taken = std::any_of(bodies.begin(), bodies.end(),
                                     [&body](const SceneBody& other) { return other.name == body.name; });
      if (taken) {
        value.at("name").fail("a name that no other body has");
      }
      bodies.push_back(std::move(body));
    }
  }
  return bodies;
}

}  // namespace shallow_sand
