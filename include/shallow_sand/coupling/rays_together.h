#pragma once

#include "shallow_sand/coupling/rays.h"
#include "shallow_sand/device/host_executor.h"
#include "shallow_sand/device/instruction_set.h"

namespace shallow_sand {

/// Casts rays on the CPU: those through a body that start in one bin march together, one in each lane of a
/// vector. Calls the same functions as castRay, so the bits are the same.
class RaysTogether {
 public:
  explicit RaysTogether(InstructionSet instructions) : instructions_(instructions) {}

  /// Calls function(i, j, solids) once for every column under the bodies' window. Function: BodiesOverBed.
  template <class Function>
  void forEachColumn(const HostExecutor& executor, const Function& function) const {
    executor.forEachPart(function.bins.window, function.bins.count(), [&](int bin) {
      SolidsOfBin solids;
      cast(function, bin, solids);
      const Window cells = function.bins.cellsOf(bin);
      for (int j = cells.row_begin; j < cells.row_end; ++j) {
        for (int i = cells.column_begin; i < cells.column_end; ++i)
          function(i, j, solids.columns[j - cells.row_begin][i - cells.column_begin]);
      }
    });
  }

 private:
  struct SolidsOfBin {
    SolidIntervals columns[BodyBins::kSize][BodyBins::kSize];  ///< by row
  };
  void cast(const BodiesOverBed& bodies, int bin, SolidsOfBin& solids) const;

  InstructionSet instructions_;
};

}  // namespace shallow_sand
