#pragma once

#include <string>
#include <vector>

#include "shallow_sand/BodyStatus.h"

namespace shallow_sand {

/// What befell bodies in one frame, for the log: one line for all links of a robot that met with the same,
/// for when a robot's base is lost, so are all its links.
class BodyNews {
 public:
  enum class Event { in_sand, lost, jumped };

  /// @param story of this body, after its name, without a full stop
  void add(Event event, const BodyStatus& body, const std::string& story);
  /// Writes the log, and forgets.
  void tell();

 private:
  struct Item {
    Event event;
    std::string robot;  ///< empty: a body on its own
    std::string name;
    std::string story;
    std::vector<std::string> alike;  ///< other links of the robot
  };
  std::vector<Item> items_;
};

}  // namespace shallow_sand
