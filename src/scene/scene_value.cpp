#include "scene_value.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <set>

#include "shallow_sand/core/nearest_name.h"
#include "shallow_sand/scene/scene.h"

namespace shallow_sand {
namespace {

std::string shortened(const std::string& text) {
  constexpr std::size_t kLongest = 60;
  return text.size() > kLongest ? text.substr(0, kLongest) + "..." : text;
}

std::string describe(const YAML::Node& node) {
  switch (node.Type()) {
    case YAML::NodeType::Scalar:
      return node.Scalar().empty() ? "an empty text" : shortened(node.Scalar());
    case YAML::NodeType::Sequence:
      return "a list of " + std::to_string(node.size());
    case YAML::NodeType::Map:
      return "a map";
    default:
      return "nothing";
  }
}

std::string listed(const std::vector<std::string>& words) {
  return std::accumulate(std::next(words.begin()), words.end(), words.front(),
                         [](const std::string& list, const std::string& word) { return list + ", " + word; });
}

/// The known key that was probably meant; empty when none is near.
std::string nearest(const std::string& key, const std::vector<std::string>& known) {
  const std::string best = nearestName(key, known);
  return editDistance(key, best) <= std::max<std::size_t>(2, best.size() / 3) ? best : std::string();
}

/// Where the value at a path such as "grid.size[0]" stands, or as much of the path as is there.
YAML::Mark markBelow(const YAML::Node& node, const std::string& path) {
  const std::size_t begin = path.find_first_not_of(".[]");
  if (begin == std::string::npos || !(node.IsMap() || node.IsSequence())) {
    return node.Mark();
  }
  const std::size_t end = std::min(path.find_first_of(".[]", begin), path.size());
  const std::string key = path.substr(begin, end - begin);
  const YAML::Node child = node.IsSequence() ? node[std::stoul(key)] : node[key];
  return child.IsDefined() ? markBelow(child, path.substr(end)) : node.Mark();
}

}  // namespace

YAML::Node loadYaml(const std::string& path, const std::string& expected) {
  std::ifstream file(path);
  if (!file || std::filesystem::is_directory(path)) {
    throw SceneError(path + ": cannot be read; expected " + expected);
  }
  try {
    return YAML::Load(file);
  } catch (const YAML::Exception& error) {
    const std::string line = error.mark.is_null() ? "" : ":" + std::to_string(error.mark.line + 1);
    throw SceneError(path + line + ": not valid YAML (" + error.msg + "); expected " + expected);
  }
}

SceneValue::SceneValue(const YAML::Node& node, const SceneSource& source)
    : SceneValue(node, "", std::make_shared<const SceneSource>(source)) {}

SceneValue::SceneValue(const YAML::Node& node, const std::string& place,
                       std::shared_ptr<const SceneSource> source)
    : node_(node), place_(place), source_(std::move(source)) {}

void SceneValue::requireMap(const std::vector<std::string>& known) const {
  if (!node_.IsMap()) {
    fail("a map with keys from: " + listed(known));
  }
  std::set<std::string> seen;
  for (const auto& entry : node_) {
    if (!entry.first.IsScalar() ||
        std::find(known.begin(), known.end(), entry.first.Scalar()) == known.end()) {
      failUnknown(entry.first, known);
    }
    if (!seen.insert(entry.first.Scalar()).second) {
      SceneValue(entry.first, placeOf(entry.first.Scalar()), source_).fail("given twice", "this key once");
    }
  }
}

std::string SceneValue::requireOneOf(const std::vector<std::string>& known) const {
  requireMap(known);
  if (node_.size() != 1) {
    fail("a map of " + std::to_string(node_.size()) + " keys", "exactly one of: " + listed(known));
  }
  return node_.begin()->first.Scalar();
}

std::optional<SceneValue> SceneValue::find(const std::string& key) const {
  if (!node_.IsMap() || !node_[key].IsDefined()) {
    return std::nullopt;
  }
  return SceneValue(node_[key], placeOf(key), source_);
}

SceneValue SceneValue::at(const std::string& key) const {
  if (const auto value = find(key)) {
    return *value;
  }
  SceneValue(node_, placeOf(key), source_).fail("missing", "this key");
}

std::vector<SceneValue> SceneValue::items() const {
  if (!node_.IsSequence()) {
    fail("a list");
  }
  std::vector<SceneValue> result;
  for (const YAML::Node& item : node_) {
    result.push_back(SceneValue(item, place_ + "[" + std::to_string(result.size()) + "]", source_));
  }
  return result;
}

std::vector<SceneValue> SceneValue::items(std::size_t count, const std::string& expected) const {
  if (!node_.IsSequence() || node_.size() != count) {
    fail(expected);
  }
  return items();
}

std::string SceneValue::text() const {
  if (!node_.IsScalar() || node_.Scalar().empty()) {
    fail("a text");
  }
  return node_.Scalar();
}

std::string SceneValue::path() const {
  const std::string written = text();
  // Among them the one that ends a text for the system: it would open another file than the one that is
  // named.
  if (std::any_of(written.begin(), written.end(), [](unsigned char c) { return std::iscntrl(c) != 0; })) {
    fail("a path without control characters");
  }
  const std::filesystem::path path = written;
  if (path.is_relative() && source_->folder.empty()) {
    fail("an absolute path, as this scene lies in no folder");
  }
  return (source_->folder / path).string();
}

double SceneValue::number(const Bound& bound) const {
  // yaml-cpp marks quoted text with the tag "!".
  double value = 0.0;
  if (!node_.IsScalar() || node_.Tag() == "!" || !YAML::convert<double>::decode(node_, value) ||
      !bound.holds(value)) {
    fail(bound.expected);
  }
  return value;
}

void SceneValue::read(const std::string& key, const Bound& bound, double& target) const {
  if (const auto value = find(key)) {
    target = value->number(bound);
  }
}

void SceneValue::read(const std::string& key, std::string& target) const {
  if (const auto value = find(key)) {
    target = value->text();
  }
}

void SceneValue::fail(const std::string& expected) const { fail(describe(node_), expected); }

void SceneValue::fail(const std::string& found, const std::string& expected) const {
  const std::string prefix = place_.empty() ? "" : place_ + ": ";
  raise(node_.Mark(), prefix + found + "; expected " + expected);
}

void SceneValue::failBelow(const std::string& message) const {
  raise(markBelow(node_, message.substr(0, message.find(": "))), placeOf(message));
}

void SceneValue::raise(const YAML::Mark& mark, const std::string& message) const {
  const std::string line = mark.is_null() ? "" : ":" + std::to_string(mark.line + 1);
  throw SceneError(source_->name + line + ": " + message);
}

std::string SceneValue::placeOf(const std::string& key) const {
  return place_.empty() ? key : place_ + "." + key;
}

void SceneValue::failUnknown(const YAML::Node& key, const std::vector<std::string>& known) const {
  const std::string name = describe(key);
  const std::string meant = nearest(name, known);
  SceneValue(key, placeOf(name), source_)
      .fail("unknown key" + (meant.empty() ? "" : " (did you mean " + meant + "?)"),
            "one of: " + listed(known));
}

}  // namespace shallow_sand
