#pragma once

#include <string>

namespace shallow_sand {

/// The text with blanks for all that is no part of a line, and the beginning and the end of one that is
/// longer than 2000 bytes: errors and logs are lines, whatever names and values they tell of.
std::string oneLine(std::string text);

}  // namespace shallow_sand
