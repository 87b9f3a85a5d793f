#include "shallow_sand/device/passive_threads.h"

#include <unistd.h>

#include <cstdlib>

namespace shallow_sand {

void waitPassively(char** arguments) {
  if (std::getenv("OMP_WAIT_POLICY") != nullptr) return;
  setenv("OMP_WAIT_POLICY", "passive", 1);
  char path[4096];
  const ssize_t length = readlink("/proc/self/exe", path, sizeof(path) - 1);
  // Without /proc the program goes on as it is.
  if (length < 0) return;
  path[length] = '\0';
  execv(path, arguments);
}

}  // namespace shallow_sand
