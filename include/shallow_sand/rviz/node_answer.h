#pragma once

#include <ros/service.h>

#include <chrono>
#include <future>
#include <string>
#include <thread>
#include <utility>

namespace shallow_sand {

/// Of a service of a node.
struct NodeAnswer {
  bool success;
  std::string message;  ///< what is wrong, or what was done
};

/// Waits for the node, so not to be called where rviz draws. A node that is not there is an answer, too.
template <class Service>
NodeAnswer askNode(const std::string& name, Service service) {
  if (!ros::service::call(name, service)) return {false, name + " does not answer"};
  return {service.response.success != 0, service.response.message};
}

/// Answers from a thread of its own: rviz may end, or a tool, while a node that hangs does not answer.
template <class Function>
std::future<NodeAnswer> answerLater(Function function) {
  std::packaged_task<NodeAnswer()> task(std::move(function));
  std::future<NodeAnswer> answer = task.get_future();
  std::thread(std::move(task)).detach();
  return answer;
}

/// Whether there is an answer that may be taken at once.
inline bool hasCome(const std::future<NodeAnswer>& answer) {
  return answer.valid() && answer.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

}  // namespace shallow_sand
