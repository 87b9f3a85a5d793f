#include "shallow_sand/device/host_executor.h"
#include "shallow_sand/solver/step_rows.h"
// Above: the CPU's stepGrid, which the engine is to find.
#include "shallow_sand/sim/engine_on.h"

namespace shallow_sand {

std::unique_ptr<Engine> makeHostEngine(const EngineStart& start, int threads) {
  return std::make_unique<EngineOn<HostExecutor>>(HostExecutor(threads), start);
}

}  // namespace shallow_sand
