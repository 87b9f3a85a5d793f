#pragma once

#include <vector>

#include "shallow_sand/sim/body_windows.h"

namespace shallow_sand {

/// Cells for a block of threads: at most as many as it has threads, of one window.
struct CellBlock {
  Window cells;
  int window;
};

/// A window that bodies may touch in a run, and where its bins begin (see BodyBins).
struct CrowdedWindow {
  Window cells;
  int first_bin;
  int bins_across;
  std::size_t first_cell;  ///< among the cells of all windows
};

/// What decides whether a body in a placement is near sand, and has moved there.
struct BodyReach {
  Window around;   ///< its columns and one more on each side; empty if it is nowhere over the grid
  float height;    ///< see reachOf [m]
  bool poured_on;  ///< sand may fall on it
  int still;       ///< placements before this one in which it has not moved, come or gone
};

/// The bodies of a run of steps, laid out for kernels: for each placement, one entry for each body that there
/// ever was.
struct RunTables {
  std::vector<double> placed_at;  ///< of the placements [s]
  std::vector<BodyView> views;    ///< the distance is null, as in PlacedBody
  std::vector<BodyReach> reaches;
  std::vector<CrowdedWindow> windows;  ///< do not overlap, and hold all columns that bodies touch
  std::vector<CellBlock> blocks;       ///< of the windows
  std::vector<Window> wide_windows;    ///< do not overlap, and hold all columns that sand is pushed to
  std::vector<CellBlock> wide_blocks;
  std::vector<int> bin_first;  ///< see BodyBins
  std::vector<int> bin_members;
};

/// @param placements with what was before the run in front
/// @param bodies how many there ever were
/// @param held windows that bodies have touched before, too
/// @param poured_on windows in which sand may fall
RunTables makeRunTables(const std::vector<Placement>& placements, std::size_t bodies,
                        const std::vector<Window>& held, const std::vector<Window>& poured_on,
                        const Grid& grid);

}  // namespace shallow_sand
