#include "shallow_sand/ros/named_frame.h"

#include <tf2/exceptions.h>

namespace shallow_sand {

Eigen::Isometry3d poseOfNamedFrame(const SandBodies& bodies, const std::string& key,
                                   const std::string& frame) {
  const std::string expected = "a tf frame that hangs together with the sand's";
  if (frame.empty()) throw InvalidParameter(key, "empty", expected);
  try {
    return bodies.poseOf(frame);
  } catch (const tf2::TransformException& problem) {
    throw InvalidParameter(key, frame + " (" + problem.what() + ")", expected);
  }
}

}  // namespace shallow_sand
