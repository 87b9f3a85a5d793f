#pragma once

#include <sys/types.h>

#include <vector>

namespace shallow_sand {

/// Other processes that never rest, as the rest of a robot's stack may be, while this object lives.
class BusyProcesses {
 public:
  explicit BusyProcesses(int count);
  ~BusyProcesses();
  BusyProcesses(const BusyProcesses&) = delete;
  BusyProcesses& operator=(const BusyProcesses&) = delete;

 private:
  std::vector<pid_t> children_;
};

}  // namespace shallow_sand
