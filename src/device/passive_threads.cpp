#include "shallow_sand/device/passive_threads.h"

#include <unistd.h>

#include <cstdlib>

namespace shallow_sand {

void waitPassively(char** arguments) {
  if (std::getenv("OMP_WAIT_POLICY") != nullptr) return;
  setenv("OMP_WAIT_POLICY", "passive", 1);
  execv("/proc/self/exe", arguments);
  // Without /proc the program goes on as it is.
}

}  // namespace shallow_sand
