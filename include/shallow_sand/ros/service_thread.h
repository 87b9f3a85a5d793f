#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>

#include <exception>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "shallow_sand/core/one_line.h"
#include "shallow_sand/ros/call_record.h"
#include "shallow_sand/ros/loop_calls.h"

namespace shallow_sand {

/// Services of the node, one request after the other on a thread of their own, so that the sand runs on
/// beside what takes long. Responses have `success` and `message`: what was done, or what is wrong and what
/// was expected; of refusals the log tells once in five seconds for each service.
class ServiceThread {
 public:
  /// @param node below which they lie
  /// @param loop must outlive this, and is closed at the end
  ServiceThread(const ros::NodeHandle& node, LoopCalls& loop);
  ~ServiceThread();

  /// @param handler of (request, response), returns the message; what it throws refuses the request
  template <class Service>
  void serve(
      const std::string& name,
      std::function<std::string(const typename Service::Request&, typename Service::Response&)> handler) {
    const auto answer = [refusals = Refusals(name), handler = std::move(handler)](
                            typename Service::Request& request,
                            typename Service::Response& response) mutable {
      try {
        response.message = handler(request, response);
        response.success = true;
      } catch (const std::exception& problem) {
        response = {};
        response.message = oneLine(problem.what());
        refusals.tell(response.message);
      }
      // False would be a failure of the call, without a message.
      return true;
    };
    servers_.push_back(node_.advertiseService<typename Service::Request, typename Service::Response>(
        name, boost::function<bool(typename Service::Request&, typename Service::Response&)>(answer)));
  }
  /// The same for requests that change the sand or its bodies, which can be replayed.
  /// @param prepare as in CallRecord::know; what it returns is done in the loop, and returns the message
  /// @param check in the loop, throws what can be refused before anything that takes long is computed
  template <class Service>
  void serveChange(
      const std::string& name, CallRecord& calls,
      std::function<std::function<std::string(typename Service::Response&)>(const typename Service::Request&)>
          prepare,
      std::function<void(const typename Service::Request&)> check = {}) {
    using Request = typename Service::Request;
    using Response = typename Service::Response;
    calls.know<Request>(name, [prepare](const Request& request) -> Change {
      return [change = prepare(request)] {
        Response nobody_reads;
        return change(nobody_reads);
      };
    });
    serve<Service>(name, [this, name, &calls, prepare, check](const Request& request, Response& response) {
      if (check) inLoop([&] { check(request); });
      const auto change = prepare(request);
      std::string done;
      inLoop([&] { done = calls.make(name, request, [&] { return change(response); }); });
      return done;
    });
  }
  /// Requests are taken from now on: when all that handlers need is there.
  void start() { spinner_.start(); }
  /// For handlers; see LoopCalls.
  void inLoop(const std::function<void()>& action) { loop_.inLoop(action); }

 private:
  class Refusals {
   public:
    explicit Refusals(std::string service) : service_(std::move(service)) {}
    void tell(const std::string& problem);

   private:
    std::string service_;
    ros::WallTime told_;
  };

  LoopCalls& loop_;
  ros::CallbackQueue queue_;
  ros::NodeHandle node_;
  std::vector<ros::ServiceServer> servers_;
  ros::AsyncSpinner spinner_{1, &queue_};
};

}  // namespace shallow_sand
