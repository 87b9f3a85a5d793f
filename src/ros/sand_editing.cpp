#include "shallow_sand/ros/sand_editing.h"

#include <sstream>

#include "shallow_sand/ros/named_frame.h"
#include "shallow_sand/ros/requested_edits.h"

namespace shallow_sand {

SandEditing::SandEditing(const ros::NodeHandle& node, LoopCalls& loop, CallRecord& calls,
                         const SandBodies& bodies, Simulator& simulator)
    : bodies_(bodies), simulator_(simulator), services_(node, loop) {
  services_.serveChange<EditSand>("edit_sand", calls,
                                  [this](const EditSand::Request& request) { return editing(request); });
  services_.start();
}

std::function<std::string(EditSand::Response&)> SandEditing::editing(const EditSand::Request& request) {
  return [this, request](EditSand::Response& response) {
    const auto frame = poseOfNamedFrame(bodies_, "center.header.frame_id", request.center.header.frame_id);
    response.volume = simulator_.edit(requestedEdit(request, frame));
    std::ostringstream done;
    done << "the sand grew by " << response.volume << " m3";
    return done.str();
  };
}

}  // namespace shallow_sand
