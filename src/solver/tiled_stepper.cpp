#include "shallow_sand/solver/tiled_stepper.h"

#include <algorithm>

#include "shallow_sand/solver/row_walker.h"

namespace shallow_sand {

namespace {

// One source, compiled for each instruction set: `flatten` inlines all that the walk calls into the function
// that has the target, so that nothing else is compiled for it.
template <class Step>
__attribute__((flatten)) void walkBaseline(RowWalker<Step>& walker) {
  walker.walk();
}
#ifdef __x86_64__
template <class Step>
__attribute__((target("avx2"), flatten)) void walkAvx2(RowWalker<Step>& walker) {
  walker.walk();
}
template <class Step>
__attribute__((target("avx512f,avx512vl,avx512dq,avx512bw"), flatten)) void walkAvx512(
    RowWalker<Step>& walker) {
  walker.walk();
}
#endif

template <class Step>
void walk(RowWalker<Step>& walker, InstructionSet instructions) {
#ifdef __x86_64__
  if (instructions == InstructionSet::avx2) return walkAvx2(walker);
  if (instructions == InstructionSet::avx512) return walkAvx512(walker);
#endif
  (void)instructions;
  walkBaseline(walker);
}

}  // namespace

TiledStepper::TiledStepper(const HostExecutor& executor, const Grid& grid, const Options& options)
    : executor_(executor), grid_(grid), options_(options), tiles_(grid) {
  for (int thread = 0; thread < executor.threads(); ++thread)
    scratch_.emplace_back(RowWalker<Step<true, true>>::scratchSize());
}

const std::vector<Window>& TiledStepper::due() {
  using Walker = RowWalker<Step<false, false>>;
  if (!options_.sleeping) tiles_.touch(Window::all(grid_));
  return tiles_.due(Walker::kWidest, Walker::kHighest);
}

float TiledStepper::attempt(const StepArguments& arguments, const std::vector<Window>& bodies,
                            const SandFieldsOut& out) {
  rectangles_ = due();
  cells_ = 0;
  stepped_ = Window{};
  for (const Window& cells : rectangles_) {
    cells_ += static_cast<long long>(cells.cells());
    stepped_ = stepped_.united(cells);
  }
  executor_.forEachTask(static_cast<int>(rectangles_.size()), [&](int task, int thread) {
    const Window& cells = rectangles_[task];
    const Window reached = cells.grown(Tiles::kReach, grid_);
    withStep(arguments, reached.overlapsAny(bodies), options_.with_slopes, [&](const auto& step) {
      RowWalker<std::decay_t<decltype(step)>> walker(step, out, cells, tiles_, scratch_[thread].data());
      walk(walker, options_.instructions);
    });
  });
  return tiles_.speed();
}

long long TiledStepper::accept() {
  tiles_.advance();
  return cells_;
}

}  // namespace shallow_sand
