#include "shallow_sand/ros/body_news.h"

#include <ros/console.h>

#include <algorithm>

namespace shallow_sand {

void BodyNews::add(Event event, const BodyStatus& body, const std::string& story) {
  const auto same = std::find_if(items_.begin(), items_.end(), [&](const Item& item) {
    return !body.robot.empty() && item.robot == body.robot && item.event == event;
  });
  if (same != items_.end()) {
    same->alike.push_back(body.name);
  } else {
    items_.push_back({event, body.robot, body.name, story, {}});
  }
}

void BodyNews::tell() {
  for (const Item& item : items_) {
    std::string line = (item.robot.empty() ? "body " : "link ") + item.name + item.story;
    for (std::size_t k = 0; k < item.alike.size(); ++k) {
      line += (k == 0 ? "; likewise links " : ", ") + item.alike[k];
    }
    switch (item.event) {
      case Event::in_sand:
        ROS_INFO_STREAM(line);
        break;
      case Event::lost:
        ROS_ERROR_STREAM(line);
        break;
      case Event::jumped:
        ROS_WARN_STREAM(line);
        break;
    }
  }
  items_.clear();
}

}  // namespace shallow_sand
