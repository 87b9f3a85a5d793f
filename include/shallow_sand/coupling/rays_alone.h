#pragma once

#include "shallow_sand/coupling/rays.h"

namespace shallow_sand {

/// Casts the ray of one column, and calls function(i, j, solids).
template <class Function>
struct CastColumn {
  Function function;

  SHALLOW_SAND_HOST_DEVICE void operator()(int i, int j) const { function(i, j, solidsAt(function, i, j)); }
};

/// Casts every ray by itself, on any executor.
struct RaysAlone {
  /// Calls function(i, j, solids) once for every column under the bodies' window. Function: BodiesOverBed.
  template <class Executor, class Function>
  void forEachColumn(Executor& executor, const Function& function) const {
    executor.forEachCell(function.bins.window, CastColumn<Function>{function});
  }
};

}  // namespace shallow_sand
