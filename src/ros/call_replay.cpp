#include "shallow_sand/ros/call_replay.h"

#include <ros/console.h>
#include <ros/names.h>

#include <boost/make_shared.hpp>
#include <memory>
#include <utility>
#include <vector>

#include "shallow_sand/core/one_line.h"
#include "shallow_sand/ros/queued_call.h"

namespace shallow_sand {
namespace {

constexpr std::size_t kMostWaiting = 1000;
/// Of one request; those that there are hold names and a few numbers. [bytes]
constexpr std::size_t kLargest = 1 << 16;
/// Between two lines of the log [s].
constexpr double kTellAgain = 5.0;

}  // namespace

CallReplay::CallReplay(ros::NodeHandle node, const std::string& topic, const CallRecord& calls,
                       const FrameClock& clock)
    : calls_(calls), clock_(clock) {
  if (topic.empty()) return;
  std::string problem;
  if (!ros::names::validate(topic, problem))
    throw InvalidParameter("replay_calls", topic + " (" + problem + ")", "the name of a topic");
  if (node.resolveName(topic) == calls.topic())
    throw InvalidParameter("replay_calls", topic, "another topic than the node's own ~calls");
  subscriber_ = node.subscribe<ServiceCall>(topic, kMostWaiting,
                                            [this](const ServiceCall::ConstPtr& call) { take(*call); });
  spinner_.start();
}

CallReplay::~CallReplay() { spinner_.stop(); }

void CallReplay::take(const ServiceCall& message) {
  if (message.request.size() > kLargest || waiting_.size() >= kMostWaiting) {
    ROS_WARN_STREAM_THROTTLE(kTellAgain, subscriber_.getTopic()
                                             << ": a call of ~" << oneLine(message.service) << " with "
                                             << message.request.size() << " bytes is refused while "
                                             << waiting_.size() << " others wait; expected at most "
                                             << kLargest << " bytes and " << kMostWaiting << " calls");
    return;
  }
  const auto task = std::make_shared<std::packaged_task<Change()>>(
      [this, service = message.service, request = message.request] {
        return calls_.prepare(service, request);
      });
  waiting_.emplace(message.header.stamp, Call{message.service, task->get_future()});
  preparing_.addCallback(boost::make_shared<QueuedCall>([task] { (*task)(); }));
}

void CallReplay::carryOutDue() {
  // A call of time zero took effect before the first frame.
  const ros::Time now = clock_.hasStarted() ? clock_.end() : ros::Time();
  while (!waiting_.empty() && waiting_.begin()->first <= now) {
    auto first = waiting_.extract(waiting_.begin());
    carryOut(first.key(), first.mapped());
  }
}

void CallReplay::carryOut(const ros::Time& stamp, Call& call) const {
  if (clock_.hasStarted() && stamp < clock_.end()) {
    ROS_WARN_STREAM_THROTTLE(kTellAgain, subscriber_.getTopic()
                                             << ": a call of ~" << oneLine(call.service) << " came "
                                             << (clock_.end() - stamp).toSec()
                                             << " s too late and is carried out now, so the sand will be "
                                                "another; a larger ~tf_delay helps");
  }
  try {
    call.change.get()();
  } catch (const std::exception& problem) {
    ROS_WARN_STREAM_THROTTLE(kTellAgain, subscriber_.getTopic()
                                             << ": a call of ~" << oneLine(call.service)
                                             << " is refused: " << oneLine(problem.what()));
  }
}

void CallReplay::restart(const ros::Time& now) { waiting_.erase(waiting_.upper_bound(now), waiting_.end()); }

}  // namespace shallow_sand
