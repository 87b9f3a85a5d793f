#pragma once

#include <yaml-cpp/yaml.h>

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "shallow_sand/core/parameters.h"

namespace shallow_sand {

/// What a number has to satisfy, in code and in the words of an error.
struct Bound {
  bool (*holds)(double value);
  const char* expected;
};

/// Where a scene comes from.
struct SceneSource {
  std::string name;    ///< the file, or what stands for it in errors
  std::string folder;  ///< that paths in the scene start from; empty: they must be absolute
};

/// What a YAML file holds. @param expected what it should be, in words. @throws SceneError
YAML::Node loadYaml(const std::string& path, const std::string& expected);

/// One value of a scene with its place in it. Every way to read it either gives what was asked for or throws
/// a SceneError that names the place.
class SceneValue {
 public:
  SceneValue(const YAML::Node& node, const SceneSource& source);

  /// Refuses anything but a map whose keys all are among `known`, each given once.
  void requireMap(const std::vector<std::string>& known) const;
  /// Refuses anything but a map with one key, which is among `known`; returns that key.
  std::string requireOneOf(const std::vector<std::string>& known) const;

  std::optional<SceneValue> find(const std::string& key) const;
  SceneValue at(const std::string& key) const;
  std::vector<SceneValue> items() const;
  std::vector<SceneValue> items(std::size_t count, const std::string& expected) const;

  std::string text() const;
  /// The path of a file, from the scene's folder on if it is not absolute.
  std::string path() const;
  bool isMap() const { return node_.IsMap(); }
  bool is(const std::string& word) const { return node_.IsScalar() && node_.Scalar() == word; }
  double number(const Bound& bound) const;
  template <int size>
  Eigen::Matrix<double, size, 1> vector(const Bound& bound) const {
    const auto values = items(size, "a list of " + std::to_string(size) + " numbers");
    Eigen::Matrix<double, size, 1> result;
    for (int k = 0; k < size; ++k) {
      result[k] = values[static_cast<std::size_t>(k)].number(bound);
    }
    return result;
  }

  /// These leave `target` as it is where the key is absent.
  void read(const std::string& key, const Bound& bound, double& target) const;
  void read(const std::string& key, std::string& target) const;
  template <int size>
  void read(const std::string& key, const Bound& bound, Eigen::Matrix<double, size, 1>& target) const {
    if (const auto value = find(key)) {
      target = value->vector<size>(bound);
    }
  }

  [[noreturn]] void fail(const std::string& expected) const;
  [[noreturn]] void fail(const std::string& found, const std::string& expected) const;
  /// Runs a check of the core, whose InvalidParameter names a key below this value, and gives its error a
  /// place.
  template <class Check>
  void check(Check run) const {
    try {
      run();
    } catch (const InvalidParameter& error) {
      failBelow(error.what());
    }
  }

 private:
  SceneValue(const YAML::Node& node, const std::string& place, std::shared_ptr<const SceneSource> source);
  std::string placeOf(const std::string& key) const;
  /// `message` begins with its key and ": ".
  [[noreturn]] void failBelow(const std::string& message) const;
  [[noreturn]] void raise(const YAML::Mark& mark, const std::string& message) const;
  [[noreturn]] void failUnknown(const YAML::Node& key, const std::vector<std::string>& known) const;

  YAML::Node node_;
  std::string place_;  ///< as in "bodies[0].shape"; empty for the whole scene
  std::shared_ptr<const SceneSource> source_;
};

}  // namespace shallow_sand
