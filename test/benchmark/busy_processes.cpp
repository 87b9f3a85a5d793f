#include "benchmark/busy_processes.h"

#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <stdexcept>

namespace shallow_sand {

BusyProcesses::BusyProcesses(int count) {
  for (int k = 0; k < count; ++k) {
    const pid_t child = fork();
    if (child < 0) throw std::runtime_error("a busy process cannot be started");
    if (child == 0) {
      prctl(PR_SET_PDEATHSIG, SIGKILL);  // none is left behind if the benchmark is stopped
      for (volatile unsigned work = 0;; work = work + 1) continue;
    }
    children_.push_back(child);
  }
}

BusyProcesses::~BusyProcesses() {
  for (const pid_t child : children_) {
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
  }
}

}  // namespace shallow_sand
