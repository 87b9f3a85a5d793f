#pragma once

#include <ros/time.h>

#include <string>
#include <vector>

#include "shallow_sand/HeightField.h"
#include "shallow_sand/HeightFieldUpdate.h"
#include "shallow_sand/device/tile_set.h"
#include "shallow_sand/ros/fields_change.h"
#include "shallow_sand/solver/sand_constants.h"

namespace shallow_sand {

/// The sand as it was sent, and what has to be sent to those who have it when it changes. Knows no transport
/// and no threads.
class HeightFieldDifference {
 public:
  /// @param frame of the sand @param with_speed whether maps have speeds
  HeightFieldDifference(const Grid& grid, const std::string& frame, const SandConstants& sand,
                        bool with_speed);

  /// What is to be sent to everybody.
  struct News {
    bool map_is_new = false;  ///< the whole map
    /// Otherwise these: rectangles that do not overlap, hold all cells that have changed in any bit, and no
    /// row or column at their sides that has not.
    std::vector<HeightFieldUpdate> updates;
  };
  /// The map is new at first, and when the bed is another. The first change must be whole.
  News take(const FieldsChange& change, const ros::Time& stamp);

  bool hasMap() const { return map_.map != 0; }
  /// With all updates in it; the stamp is that of the last change that was taken.
  const HeightField& map() const { return map_; }
  /// Says which update was the last.
  HeightFieldUpdate sequence() const;

 private:
  void makeMap(const FieldsChange& change);
  void takeLoads(const FieldsChange& change);
  void takeCells(const FieldsChange& change);
  float speedOf(const Fields& values, std::size_t k) const;
  std::vector<Window> rectangles();
  Window changedIn(const Window& cells) const;
  HeightFieldUpdate updateOf(const Window& cells);

  Grid grid_;
  SandConstants sand_;
  bool with_speed_;
  HeightField map_;
  TileSet changed_;
  int tiles_across_;
  std::vector<Window> changed_cells_;  ///< of each tile
};

}  // namespace shallow_sand
