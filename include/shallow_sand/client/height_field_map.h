#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "shallow_sand/HeightField.h"
#include "shallow_sand/HeightFieldUpdate.h"

namespace shallow_sand {

/// Some cells of a map: the first, and how many.
struct CellRectangle {
  std::uint32_t column;
  std::uint32_t row;
  std::uint32_t columns;
  std::uint32_t rows;
};

/// A copy of the node's sand, put together from its messages: bit for bit what the node has, or it knows that
/// something is missing. Knows no transport and no threads.
class HeightFieldMap {
 public:
  /// What a message did to the copy.
  struct Change {
    bool made_anew = false;            ///< there is another map now, perhaps of another size
    std::vector<CellRectangle> cells;  ///< that may have changed since, unless the map was made anew
    std::string refused;  ///< what is wrong with the message and what was expected; empty if nothing is
  };

  Change take(const HeightField& message);
  /// Updates must come in the order in which they were sent. One that does not follow what is known waits
  /// for a whole map.
  Change take(const HeightFieldUpdate& message);

  /// The sand with all updates in it; its header is that of the newest. Null until a map has come.
  const HeightField* field() const { return field_ ? &*field_ : nullptr; }
  /// Updates wait for a map, or one was refused. If none is on its way, one has to be asked for.
  bool needsMap() const { return missing_ || !waiting_.empty(); }

 private:
  void replace(const HeightField& message, Change& change);
  void applyWaiting(Change& change);
  void keepWaiting(const HeightFieldUpdate& update);
  void dropOldestWaiting();

  std::optional<HeightField> field_;
  std::optional<HeightField> earlier_;  // a map that came when updates after it were known already
  std::deque<HeightFieldUpdate> waiting_;
  std::uint64_t waiting_cells_ = 0;
  bool missing_ = false;  // an update was refused
};

}  // namespace shallow_sand
