#pragma once

#include <visualization_msgs/Marker.h>

#include "shallow_sand/AddBody.h"
#include "shallow_sand/scene/scene.h"

namespace shallow_sand {

/// A marker that looks like a body: its type, scale, mesh and colour. Name, frame and pose are left out.
visualization_msgs::Marker lookOf(const SceneBody& body);
visualization_msgs::Marker lookOf(const AddBody::Request& request);

}  // namespace shallow_sand
