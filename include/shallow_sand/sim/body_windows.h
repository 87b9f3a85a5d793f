#pragma once

#include <vector>

#include "shallow_sand/coupling/body_bins.h"
#include "shallow_sand/device/window.h"

namespace shallow_sand {

/// A body at one instant; `view.field.distance` and `view.number` are filled in by the engine.
struct PlacedBody {
  std::size_t body;
  BodyView view;
  Window window;  ///< columns it may touch
  int still = 0;  ///< placements before this one in which it has been just here, without a gap
};

/// Where all bodies are at an instant.
struct Placement {
  double time;  ///< [s]
  std::vector<PlacedBody> bodies;
};

/// Sand that reaches above this is near a body; far below, it needs not be looked at. [m]
float reachOf(const PlacedBody& body, const Grid& grid);

/// Rectangles that hold all the given ones, and do not overlap.
std::vector<Window> withoutOverlap(std::vector<Window> windows);

/// The members of BodyBins for several windows, in lists of their own for each.
struct BinLists {
  std::vector<int> first;
  std::vector<int> members;               ///< indices in the list of placed bodies
  std::vector<std::size_t> first_begins;  ///< where each window's part of `first` begins
  std::vector<int> across;                ///< bins along x of each window
};

BinLists binLists(const std::vector<PlacedBody>& bodies, const std::vector<Window>& windows);

}  // namespace shallow_sand
