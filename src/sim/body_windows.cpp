#include "shallow_sand/sim/body_windows.h"

namespace shallow_sand {

namespace {

/// Calls function(bin) for the bins of a window that a body's columns lie in.
template <class Function>
void forEachBin(const PlacedBody& body, const Window& window, int across, const Function& function) {
  const Window common = body.window.overlap(window);
  if (common.empty()) return;
  const auto bin = [](int cell, int begin) { return (cell - begin) / BodyBins::kSize; };
  for (int y = bin(common.row_begin, window.row_begin); y <= bin(common.row_end - 1, window.row_begin); ++y) {
    for (int x = bin(common.column_begin, window.column_begin);
         x <= bin(common.column_end - 1, window.column_begin); ++x)
      function(y * across + x);
  }
}

}  // namespace

float reachOf(const PlacedBody& body, const Grid& grid) {
  constexpr float kNearSand = 4.0f;  // [cells]
  return body.view.low.z - kNearSand * grid.spacing;
}

std::vector<Window> withoutOverlap(std::vector<Window> windows) {
  std::vector<Window> apart;
  while (!windows.empty()) {
    Window next = windows.back();
    windows.pop_back();
    if (next.empty()) continue;
    for (std::size_t k = 0; k < apart.size(); ++k) {
      if (apart[k].overlap(next).empty()) continue;
      // The union may reach others that were apart before: it is looked at anew.
      windows.push_back(next.united(apart[k]));
      apart.erase(apart.begin() + static_cast<std::ptrdiff_t>(k));
      next = Window{};
      break;
    }
    if (!next.empty()) apart.push_back(next);
  }
  return apart;
}

BinLists binLists(const std::vector<PlacedBody>& bodies, const std::vector<Window>& windows) {
  BinLists lists;
  for (const Window& window : windows) {
    const int across = (window.columns() + BodyBins::kSize - 1) / BodyBins::kSize;
    const int bins = across * ((window.rows() + BodyBins::kSize - 1) / BodyBins::kSize);
    std::vector<std::vector<int>> members(static_cast<std::size_t>(bins));
    for (std::size_t k = 0; k < bodies.size(); ++k) {
      forEachBin(bodies[k], window, across,
                 [&](int bin) { members[static_cast<std::size_t>(bin)].push_back(static_cast<int>(k)); });
    }
    lists.first_begins.push_back(lists.first.size());
    lists.across.push_back(across);
    for (const std::vector<int>& bin : members) {
      lists.first.push_back(static_cast<int>(lists.members.size()));
      lists.members.insert(lists.members.end(), bin.begin(), bin.end());
    }
    lists.first.push_back(static_cast<int>(lists.members.size()));
  }
  return lists;
}

}  // namespace shallow_sand
