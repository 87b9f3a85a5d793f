#pragma once

#include <ros/node_handle.h>
#include <ros/serialization.h>

#include <any>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "shallow_sand/ServiceCall.h"
#include "shallow_sand/ros/bounded_stream.h"
#include "shallow_sand/ros/frame_clock.h"

namespace shallow_sand {

/// What a request does to the sand or its bodies, in the loop. Returns what was done, in words; what it
/// throws refuses the request.
using Change = std::function<std::string()>;

/// Publishes on ~calls each request that has changed the sand or its bodies, when it has; and knows how to
/// make such changes from what was published.
class CallRecord {
 public:
  /// @param node below which ~calls lies. @param clock of the sand, must outlive this
  CallRecord(ros::NodeHandle node, const FrameClock& clock, const std::string& sand_frame);

  /// @param prepare checks a request of this kind and computes what takes long, in any thread
  template <class Request>
  void know(const std::string& service, std::function<Change(const Request&)> prepare) {
    preparers_[service] = prepare;
    readers_[service] = [this, service, prepare = std::move(prepare)](const Bytes& bytes) -> Change {
      const Request request = readMessage<Request>(bytes);
      return [this, service, request, change = prepare(request)] { return make(service, request, change); };
    };
  }
  /// In the loop: makes the change that a request asks for, and publishes the request.
  template <class Request>
  std::string make(const std::string& service, const Request& request, const Change& change) const {
    std::string done = change();
    publish(service, write(request));
    return done;
  }
  /// The same for a request of a kind that is known.
  template <class Request>
  std::string make(const std::string& service, const Request& request) const {
    using Prepare = std::function<Change(const Request&)>;
    return make(service, request, std::any_cast<const Prepare&>(preparers_.at(service))(request));
  }
  /// Of a request as it was published, in any thread. @throws InvalidParameter if it is of no kind that is
  /// known; std::exception if it cannot be read, or is refused
  Change prepare(const std::string& service, const std::vector<std::uint8_t>& request) const;
  std::string topic() const { return publisher_.getTopic(); }

 private:
  using Bytes = std::vector<std::uint8_t>;

  template <class Request>
  static Bytes write(const Request& request) {
    Bytes bytes(ros::serialization::serializationLength(request));
    ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
    ros::serialization::serialize(stream, request);
    return bytes;
  }
  void publish(const std::string& service, Bytes request) const;

  const FrameClock& clock_;
  std::string sand_frame_;
  std::map<std::string, std::any> preparers_;  ///< as they were given to know()
  std::map<std::string, std::function<Change(const Bytes&)>> readers_;
  ros::Publisher publisher_;
};

}  // namespace shallow_sand
