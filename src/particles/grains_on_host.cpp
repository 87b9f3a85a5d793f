#include "shallow_sand/particles/grains_on_host.h"

namespace shallow_sand {

namespace {

template <class Function>
void forEachCell(const Window& cells, const Function& function) {
  for (int j = cells.row_begin; j < cells.row_end; ++j) {
    for (int i = cells.column_begin; i < cells.column_end; ++i) function(i, j);
  }
}

/// Calls function(s, t, d) for the cells of J in a window of cells of I.
template <class Function>
void forEachGrain(const GrainGrid& grains, const Window& cells, const Function& function) {
  const int n = grains.per_cell;
  const Window in_j{n * cells.column_begin, n * cells.row_begin, n * cells.column_end, n * cells.row_end};
  for (int d = 0; d < grains.layers; ++d) forEachCell(in_j, [&](int s, int t) { function(s, t, d); });
}

}  // namespace

void moveGrains(const HostExecutor& executor, const GrainMove& move, const std::vector<Window>& awake) {
  const GrainGrid& grains = move.flow.grains;
  const auto tile = [&](const TileList& list, int k) {
    return list.cellsOf(k, move.flow.sand.step.columns, move.flow.sand.step.rows);
  };
  *move.moving.length = 0;
  *move.reached.length = 0;
  executor.forEachTask(static_cast<int>(awake.size()), [&](int task, int) {
    forEachCell(awake[static_cast<std::size_t>(task)], [&](int i, int j) { move.findFlow(i, j); });
  });
  executor.forEachTask(*move.moving.length, [&](int k, int) {
    const Window cells = tile(move.moving, k);
    move.reached.add(cells.column_begin, cells.row_begin);
    forEachGrain(grains, cells, [&](int s, int t, int d) { move.claim(s, t, d); });
  });
  const int reached = *move.reached.length;
  executor.forEachTask(reached, [&](int k, int) {
    const bool moves = move.moving.holds(move.reached.tiles[k]);
    forEachGrain(grains, tile(move.reached, k), [&](int s, int t, int d) { move.settle(s, t, d, moves); });
  });
  executor.forEachTask(reached, [&](int k, int) {
    const Window cells = tile(move.reached, k);
    forEachGrain(grains, cells, [&](int s, int t, int d) { move.finish(s, t, d); });
    forEachCell(cells, [&](int i, int j) { move.clearFlow(i, j); });
    for (const TileList* list : {&move.moving, &move.reached}) list->remove(move.reached.tiles[k]);
  });
}

}  // namespace shallow_sand
