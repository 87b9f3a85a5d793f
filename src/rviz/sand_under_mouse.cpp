#include "shallow_sand/rviz/sand_under_mouse.h"

#include <OGRE/OgreCamera.h>
#include <OGRE/OgreRay.h>
#include <OGRE/OgreViewport.h>
#include <rviz/display_context.h>
#include <rviz/display_group.h>
#include <rviz/viewport_mouse_event.h>

namespace shallow_sand {
namespace {

/// Calls function(display) for each height field of a group and the groups in it.
template <class Function>
void forEachHeightField(rviz::DisplayGroup& group, const Function& function) {
  for (int k = 0; k < group.numDisplays(); ++k) {
    rviz::Display* display = group.getDisplayAt(k);
    if (!display->isEnabled()) continue;
    if (auto* inner = qobject_cast<rviz::DisplayGroup*>(display)) forEachHeightField(*inner, function);
    if (auto* field = qobject_cast<HeightFieldDisplay*>(display)) function(*field);
  }
}

}  // namespace

std::optional<SandUnderMouse> sandUnderMouse(rviz::DisplayContext& context,
                                             const rviz::ViewportMouseEvent& event) {
  const auto share = [](int position, int length) {
    return (static_cast<float>(position) + 0.5f) / static_cast<float>(length);
  };
  const Ogre::Viewport& viewport = *event.viewport;
  const Ogre::Ray ray = viewport.getCamera()->getCameraToViewportRay(
      share(event.x, viewport.getActualWidth()), share(event.y, viewport.getActualHeight()));
  std::optional<SandUnderMouse> found;
  forEachHeightField(*context.getRootDisplayGroup(), [&](HeightFieldDisplay& display) {
    const std::optional<SandPlace> place = display.meet(ray);
    if (!place) return;
    const auto distance = [&](const SandPlace& other) {
      return ray.getOrigin().squaredDistance(other.in_scene);
    };
    if (!found || distance(*place) < distance(found->place))
      found = {&display, *place, display.inMap(ray.getDirection())};
  });
  return found;
}

}  // namespace shallow_sand
