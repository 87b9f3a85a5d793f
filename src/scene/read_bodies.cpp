#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>

#include "bounds.h"
#include "scene_reader.h"
#include "shallow_sand/bodies/robot_links.h"

namespace shallow_sand {
namespace {

Cylinder readCylinder(const SceneValue& value) {
  value.requireMap({"radius", "length"});
  return {value.at("radius").number(bounds::positive), value.at("length").number(bounds::positive)};
}

constexpr Bound kScale{[](double v) { return std::abs(v) >= 1e-9 && std::abs(v) <= 1e9; },
                       "a number from 1e-9 to 1e9, or the negative of one, which mirrors"};

/// A package:// or file:// address as it is, anything else as the path of a file.
std::string uriFrom(const SceneValue& value) {
  const std::string written = value.text();
  for (const char* scheme : {"package://", "file://"}) {
    if (written.rfind(scheme, 0) == 0) return written;
  }
  if (written.find("://") != std::string::npos) {
    value.fail("package://PACKAGE/PATH, file:///PATH or the path of a file");
  }
  return value.path();
}

void readMeshInto(SceneBody& body, const SceneValue& value) {
  value.requireMap({"mesh", "scale", "as"});
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
  value.read("scale", kScale, scale);
  const std::string uri = uriFrom(value.at("mesh"));
  value.check([&] { body.shape = readMesh(uri, scale); });
  body.mesh_uri = uri;
  body.mesh_scale = scale;
  if (const auto as = value.find("as")) {
    value.check([&] { body.stands_for = linkShapeFromString(as->text(), "as"); });
  }
}

void readShapeInto(SceneBody& body, const SceneValue& value) {
  if (value.find("mesh")) {
    readMeshInto(body, value);
    return;
  }
  const std::string kind = value.requireOneOf({"box", "cylinder", "sphere", "mesh"});
  const SceneValue shape = value.at(kind);
  if (kind == "box") {
    body.shape = Box{shape.vector<3>(bounds::positive)};
  } else if (kind == "cylinder") {
    body.shape = readCylinder(shape);
  } else {
    body.shape = Sphere{shape.number(bounds::positive)};
  }
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

std::vector<PoseKey> readMotion(const SceneValue& value);

/// From a file that holds such a list. One that a program wrote may be long, but no device that never ends.
std::vector<PoseKey> readMotionFile(const SceneValue& file) {
  constexpr std::uintmax_t kLargest = std::uintmax_t{16} << 20;
  const std::string path = file.path();
  std::error_code missing;
  const bool is_file = std::filesystem::is_regular_file(path, missing);
  if (!is_file || std::filesystem::file_size(path, missing) > kLargest)
    file.fail(path, "a file with a list of poses, of at most 16 MiB");
  const YAML::Node list = loadYaml(path, "a list of poses");
  if (!list.IsSequence()) throw SceneError(path + ": expected a list of poses");
  return readMotion(SceneValue(list, {path, ""}));
}

/// A list of poses, or the file that holds it.
std::vector<PoseKey> readMotion(const SceneValue& value) {
  if (value.isMap()) {
    value.requireMap({"file"});
    return readMotionFile(value.at("file"));
  }
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
  SceneBody body;
  body.name = value.at("name").text();
  readShapeInto(body, value.at("shape"));
  body.motion = readMotion(value.at("motion"));
  return body;
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
