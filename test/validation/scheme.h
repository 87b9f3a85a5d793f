#pragma once

#include "shallow_sand/core/parameters.h"

namespace shallow_sand {

/// A way to solve that is validated.
struct Scheme {
  const char* name;
  Reconstruction reconstruction;
  double courant;

  SolverParameters parameters() const {
    SolverParameters parameters;
    parameters.reconstruction = reconstruction;
    parameters.courant = courant;
    return parameters;
  }
  /// Whether this is the default scheme, of first order.
  bool isFirstOrder() const { return reconstruction == Reconstruction::constant; }
};

/// With slopes, longer steps sharpen sand into terraces: steps are explicit and of first order in time.
constexpr Scheme kSchemes[] = {{"constant", Reconstruction::constant, 0.45},
                               {"minmod", Reconstruction::minmod, 0.25}};

}  // namespace shallow_sand
