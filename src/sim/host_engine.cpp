#include "shallow_sand/coupling/rays_together.h"
#include "shallow_sand/device/host_executor.h"
#include "shallow_sand/sim/engine_on.h"
#include "shallow_sand/solver/tiled_stepper.h"

namespace shallow_sand {

std::unique_ptr<SteppedEngine> makeHostEngine(const EngineStart& start, int threads, bool sleeping,
                                              InstructionSet instructions) {
  return std::make_unique<EngineOn<HostExecutor, RaysTogether, TiledStepper>>(
      HostExecutor(threads), RaysTogether(instructions), start, start.grid,
      TiledStepper::Options{start.with_slopes, sleeping, instructions});
}

}  // namespace shallow_sand
