#pragma once

#include "shallow_sand/AddBody.h"
#include "shallow_sand/bodies/shape.h"

namespace shallow_sand {

/// The surface of the body that a request asks for, in the body's frame. It reads the mesh if there is one.
/// @throws InvalidParameter naming the field of the request
TriangleMesh requestedMesh(const AddBody::Request& request);

}  // namespace shallow_sand
