#include "shallow_sand/sim/run_tables.h"

#include <algorithm>
#include <limits>

#include "shallow_sand/coupling/pushed_sand.h"
#include "shallow_sand/device/block_size.h"

namespace shallow_sand {

namespace {

/// A ray meets no body that is not there.
BodyView nowhere() {
  constexpr float kFar = std::numeric_limits<float>::infinity();
  BodyView view{};
  view.low = {kFar, kFar, kFar};
  view.high = {-kFar, -kFar, -kFar};
  return view;
}

std::vector<CellBlock> blocksOf(const std::vector<Window>& windows) {
  std::vector<CellBlock> blocks;
  for (std::size_t k = 0; k < windows.size(); ++k) {
    const Window& window = windows[k];
    for (int j = window.row_begin; j < window.row_end; j += kBlockRows) {
      for (int i = window.column_begin; i < window.column_end; i += kBlockColumns) {
        const Window cells{i, j, i + kBlockColumns, j + kBlockRows};
        blocks.push_back({cells.overlap(window), static_cast<int>(k)});
      }
    }
  }
  return blocks;
}

void addPlacement(const Placement& placement, std::size_t bodies, const std::vector<Window>& poured_on,
                  const Grid& grid, RunTables& tables) {
  const std::size_t begin = tables.views.size();
  tables.placed_at.push_back(placement.time);
  tables.views.resize(begin + bodies, nowhere());
  tables.reaches.resize(begin + bodies, BodyReach{Window{}, 0.0f, false, 0});
  for (const PlacedBody& body : placement.bodies) {
    const Window around = body.window.grown(1, grid);
    tables.views[begin + body.body] = body.view;
    tables.views[begin + body.body].number = static_cast<int>(body.body);
    const bool has_come = begin == 0 || tables.reaches[begin - bodies + body.body].around.empty();
    tables.reaches[begin + body.body] = {around, reachOf(body, grid), around.overlapsAny(poured_on),
                                         has_come ? 0 : body.still};
  }
}

/// For each body, the window around all of its columns in the run.
std::vector<PlacedBody> sweptBodies(const RunTables& tables, std::size_t bodies) {
  std::vector<PlacedBody> swept(bodies);
  for (std::size_t k = 0; k < tables.reaches.size(); ++k) {
    Window& window = swept[k % bodies].window;
    window = window.united(tables.reaches[k].around);
  }
  return swept;
}

}  // namespace

RunTables makeRunTables(const std::vector<Placement>& placements, std::size_t bodies,
                        const std::vector<Window>& held, const std::vector<Window>& poured_on,
                        const Grid& grid) {
  RunTables tables;
  for (const Placement& placement : placements) addPlacement(placement, bodies, poured_on, grid, tables);
  const std::vector<PlacedBody> swept = sweptBodies(tables, bodies);
  std::vector<Window> touched = held;
  for (const PlacedBody& body : swept) touched.push_back(body.window);
  const std::vector<Window> windows = withoutOverlap(touched);
  const BinLists lists = binLists(swept, windows);
  std::size_t cells = 0;
  for (std::size_t k = 0; k < windows.size(); ++k) {
    tables.windows.push_back({windows[k], static_cast<int>(lists.first_begins[k]), lists.across[k], cells});
    cells += windows[k].cells();
  }
  tables.bin_first = lists.first;
  tables.bin_members = lists.members;
  tables.blocks = blocksOf(windows);
  std::vector<Window> wide = windows;
  for (Window& window : wide) window = window.grown(kPassesOfPushedSand, grid);
  tables.wide_windows = withoutOverlap(wide);
  tables.wide_blocks = blocksOf(tables.wide_windows);
  return tables;
}

}  // namespace shallow_sand
