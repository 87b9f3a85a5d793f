#pragma once

#include <cstdint>

namespace shallow_sand {

/// What is above the ground's sand of a column.
enum class Cover : std::uint8_t {
  none,
  touching,  ///< a body that touches it, and takes the ground's place with the sand on it
  hanging    ///< a body with a gap below it
};

}  // namespace shallow_sand
