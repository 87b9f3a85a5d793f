#include "shallow_sand/ros/sand_setting.h"

#include <ros/init.h>
#include <ros/master.h>
#include <ros/names.h>
#include <ros/this_node.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "shallow_sand/ros/message_heights.h"
#include "shallow_sand/ros/named_frame.h"
#include "shallow_sand/scene/terrain_heights.h"
#include "shallow_sand/surface/cell_heights.h"

namespace shallow_sand {
namespace {

constexpr double kLongestWait = 60.0;

const char kCloud[] = "sensor_msgs/PointCloud2";
const char kMarker[] = "visualization_msgs/Marker";

EditOperation operationOf(const SetSand::Request& request) {
  if (request.heights_as == "depth") return EditOperation::set;
  if (request.heights_as == "surface") return EditOperation::level;
  throw InvalidParameter("heights_as", request.heights_as.empty() ? "empty" : request.heights_as,
                         "depth or surface");
}

[[noreturn]] void failToCome(const SetSand::Request& request) {
  throw InvalidParameter(
      "topic", request.topic + ", which brought nothing in " + std::to_string(request.timeout) + " s",
      std::string("a ") + kCloud + " or a " + kMarker);
}

/// What is published on a topic; empty if the master knows no publisher. It asks once, and waits for no
/// master.
std::string typeOf(const std::string& topic) {
  XmlRpc::XmlRpcValue request, response, topics;
  request[0] = ros::this_node::getName();
  request[1] = "";
  if (!ros::master::execute("getPublishedTopics", request, response, topics, false)) return "";
  for (int k = 0; k < topics.size(); ++k) {
    if (std::string(topics[k][0]) == topic) return topics[k][1];
  }
  return "";
}

void pause() { ros::WallDuration(0.02).sleep(); }

std::string waitForType(const SetSand::Request& request, const std::string& topic, const ros::WallTime& end) {
  while (ros::ok() && ros::WallTime::now() < end) {
    const std::string type = typeOf(topic);
    if (!type.empty()) return type;
    pause();
  }
  failToCome(request);
}

}  // namespace

SandSetting::SandSetting(const ros::NodeHandle& node, LoopCalls& loop, const SandBodies& bodies,
                         Simulator& simulator)
    : bodies_(bodies), simulator_(simulator), grid_(simulator.grid()), services_(node, loop) {
  services_.serve<SetSand>("set_sand", [this](const SetSand::Request& request, SetSand::Response& response) {
    return set(request, response);
  });
  services_.start();
}

std::string SandSetting::set(const SetSand::Request& request, SetSand::Response& response) {
  const EditOperation operation = operationOf(request);
  if (request.file.empty() == request.topic.empty())
    throw InvalidParameter("file and topic", request.file.empty() ? "none" : "both", "one of the two");
  const CellValues heights = heightsFrom(request);
  const auto cells = std::count_if(heights.given.begin(), heights.given.end(),
                                   [](std::uint8_t is_given) { return is_given != 0; });
  if (cells == 0) {
    throw InvalidParameter(request.file.empty() ? "topic" : "file",
                           request.file + request.topic + ", which tells of no cell of the map",
                           "heights of some");
  }
  requireBounded(heights, grid_);
  services_.inLoop([&] { response.volume = simulator_.setSand(operation, heights); });
  std::ostringstream done;
  done << cells << " of " << grid_.cells() << " cells are set; the sand grew by " << response.volume << " m3";
  return done.str();
}

CellValues SandSetting::heightsFrom(const SetSand::Request& request) {
  if (request.topic.empty()) {
    // GDAL knows names that reach for the network, which look like absolute paths.
    std::error_code error;
    const std::filesystem::path path = request.file;
    if (!path.is_absolute() || !std::filesystem::is_regular_file(path, error))
      throw InvalidParameter("file", request.file, "the absolute path of a file that is there");
    return readTerrainHeights(request.file, grid_);
  }
  if (!(request.timeout > 0.0 && request.timeout <= kLongestWait)) {
    throw InvalidParameter("timeout", std::to_string(request.timeout),
                           "seconds above 0, at most " + std::to_string(kLongestWait));
  }
  std::string problem;
  if (!ros::names::validate(request.topic, problem))
    throw InvalidParameter("topic", request.topic + " (" + problem + ")", "the name of a topic");
  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(request.timeout);
  const std::string type = waitForType(request, ros::names::resolve(request.topic), end);
  if (type == kCloud) return heightsFromTopic<sensor_msgs::PointCloud2>(request, end);
  if (type == kMarker) return heightsFromTopic<visualization_msgs::Marker>(request, end);
  throw InvalidParameter("topic", request.topic + " of type " + type,
                         std::string("a ") + kCloud + " or a " + kMarker);
}

template <class Message>
CellValues SandSetting::heightsFromTopic(const SetSand::Request& request, const ros::WallTime& end) {
  ros::CallbackQueue queue;
  ros::NodeHandle node;
  node.setCallbackQueue(&queue);
  boost::shared_ptr<const Message> message;
  const ros::Subscriber subscriber = node.subscribe<Message>(
      request.topic, 1, [&message](const boost::shared_ptr<const Message>& came) { message = came; });
  while (message == nullptr) {
    if (!ros::ok() || ros::WallTime::now() >= end) failToCome(request);
    queue.callAvailable(ros::WallDuration(0.02));
  }
  return heightsOf(*message, poseOf(message->header.frame_id), grid_);
}

Eigen::Isometry3d SandSetting::poseOf(const std::string& frame) {
  Eigen::Isometry3d pose;
  services_.inLoop([&] { pose = poseOfNamedFrame(bodies_, "header.frame_id", frame); });
  return pose;
}

}  // namespace shallow_sand
