#pragma once

#include <vector>

#include "shallow_sand/core/fields.h"
#include "shallow_sand/coupling/sand_contact.h"
#include "shallow_sand/device/instruction_set.h"
#include "shallow_sand/sim/body_windows.h"

namespace shallow_sand {

/// What each of these bodies does to the sand, in their order; without names, and without what they gave.
/// @param fields sand that has made way for the bodies where they are
/// @param bodies with distance fields on the host; their `body` is not read
std::vector<SandContact> sandContacts(const Grid& grid, const Fields& fields,
                                      const std::vector<PlacedBody>& bodies, InstructionSet instructions);

}  // namespace shallow_sand
