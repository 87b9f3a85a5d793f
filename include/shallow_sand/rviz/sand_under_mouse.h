#pragma once

#include <QPointer>
#include <optional>

#include "shallow_sand/rviz/height_field_display.h"

namespace rviz {
class DisplayContext;
class ViewportMouseEvent;
}  // namespace rviz

namespace shallow_sand {

/// What a tool points at.
struct SandUnderMouse {
  QPointer<HeightFieldDisplay> display;  ///< whose sand is nearest to the eye there
  SandPlace place;
  Ogre::Vector3 direction;  ///< of the view there, in the map's frame
};

/// Nothing if no sand that is shown lies under the mouse.
std::optional<SandUnderMouse> sandUnderMouse(rviz::DisplayContext& context,
                                             const rviz::ViewportMouseEvent& event);

}  // namespace shallow_sand
