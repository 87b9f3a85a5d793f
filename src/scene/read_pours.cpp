#include "bounds.h"
#include "scene_reader.h"

namespace shallow_sand {
namespace {

Pour readPour(const SceneValue& value) {
  value.requireMap({"position", "radius", "rate", "start", "stop"});
  Pour pour;
  pour.position = value.at("position").vector<2>(bounds::finite);
  pour.rate = value.at("rate").number(bounds::finite);
  value.read("radius", bounds::finite, pour.radius);
  value.read("start", bounds::finite, pour.start);
  value.read("stop", bounds::finite_or_infinite, pour.stop);
  value.check([&] { pour.validate(); });
  return pour;
}

}  // namespace

std::vector<Pour> readPours(const SceneValue& root) {
  std::vector<Pour> pours;
  if (const auto list = root.find("pours")) {
    for (const SceneValue& value : list->items()) {
      pours.push_back(readPour(value));
    }
  }
  return pours;
}

}  // namespace shallow_sand
