#include "shallow_sand/ros/call_record.h"

namespace shallow_sand {
namespace {

/// As many as may come between two frames: pours.
constexpr std::uint32_t kMostWaiting = 1000;

}  // namespace

CallRecord::CallRecord(ros::NodeHandle node, const FrameClock& clock, const std::string& sand_frame)
    : clock_(clock),
      sand_frame_(sand_frame),
      publisher_(node.advertise<ServiceCall>("calls", kMostWaiting)) {}

Change CallRecord::prepare(const std::string& service, const Bytes& request) const {
  const auto reader = readers_.find(service);
  if (reader != readers_.end()) return reader->second(request);
  std::string known;
  for (const auto& other : readers_) known += (known.empty() ? "" : ", ") + other.first;
  throw InvalidParameter("service", service, "one of " + known);
}

void CallRecord::publish(const std::string& service, Bytes request) const {
  ServiceCall call;
  if (clock_.hasStarted()) call.header.stamp = clock_.end();
  call.header.frame_id = sand_frame_;
  call.service = service;
  call.request = std::move(request);
  publisher_.publish(call);
}

}  // namespace shallow_sand
