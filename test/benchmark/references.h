#pragma once

#include <vector>

#include "benchmark/maps.h"
#include "shallow_sand/device/host_executor.h"
#include "shallow_sand/solver/grid_stepper.h"
#include "shallow_sand/solver/sand_constants.h"

namespace shallow_sand {

/// The fields of a step outside of a simulator; what the step's speed is compared to works on them.
class BareFields {
 public:
  explicit BareFields(const Map& map) : parameters_(map.parameters), grid_(parameters_.grid.grid()) {
    for (int k = 0; k < 7; ++k) memory_.emplace_back(grid_.cells(), 0.0f);
    memory_[kBed].upload(map.bed.data(), map.bed.size());
    memory_[kDepth].upload(map.depth.data(), map.depth.size());
  }

  const Grid& grid() const { return grid_; }
  StepArguments arguments(float dt) const {
    StepArguments step{};
    step.in.depth = memory_[from_ + kDepth].data();
    step.in.momentum_x = memory_[from_ + kDepth + 1].data();
    step.in.momentum_y = memory_[from_ + kDepth + 2].data();
    step.in.bed = memory_[kBed].data();
    step.sand = sandConstants(grid_, parameters_.gravity, parameters_.material);
    step.columns = grid_.columns;
    step.rows = grid_.rows;
    step.setTimeStep(dt);
    return step;
  }
  SandFieldsOut out() {
    const int to = 3 - from_;
    return {memory_[to + kDepth].data(), memory_[to + kDepth + 1].data(), memory_[to + kDepth + 2].data()};
  }
  void swap() { from_ = 3 - from_; }

 private:
  static constexpr int kBed = 0;
  static constexpr int kDepth = 1;  // of the state; hu and hv follow, and then the other state
  SimulatorParameters parameters_;
  Grid grid_;
  std::vector<HostExecutor::Memory<float>> memory_;
  int from_ = 0;
};

/// Reads h, hu, hv and b and writes h, hu and hv of the cells [begin, end).
void copyFields(const SandFields& in, const SandFieldsOut& out, long long begin, long long end);

/// Moves the bytes that a step must move, 28 a cell, and computes next to nothing: no step can be faster.
class CopyingStep {
 public:
  CopyingStep(const Map& map, int threads) : fields_(map), executor_(threads) {}

  void operator()() {
    const StepArguments step = fields_.arguments(kStep);
    const SandFieldsOut out = fields_.out();
    const int bands = (step.rows + kBand - 1) / kBand;
    executor_.forEachTask(bands, [&](int band, int) {
      const long long begin = static_cast<long long>(band) * kBand * step.columns;
      const int rows = std::min(kBand, step.rows - band * kBand);
      copyFields(step.in, out, begin, begin + static_cast<long long>(rows) * step.columns);
    });
    fields_.swap();
  }

 private:
  static constexpr float kStep = 0.003f;
  static constexpr int kBand = 16;
  BareFields fields_;
  HostExecutor executor_;
};

/// The step as the same functions say it cell by cell, with nothing kept from one cell to the next.
class PlainStep {
 public:
  PlainStep(const Map& map, int threads) : fields_(map), executor_(threads), stepper_(executor_, false) {}

  void operator()() {
    stepper_.attempt(fields_.arguments(kStep), {}, fields_.out());
    fields_.swap();
  }

 private:
  static constexpr float kStep = 0.003f;
  BareFields fields_;
  HostExecutor executor_;
  GridStepper<HostExecutor> stepper_;
};

}  // namespace shallow_sand
