#pragma once

#include <algorithm>
#include <cctype>
#include <stdexcept>
#include <string>

namespace shallow_sand {

/// What a user is told has to be one line that says what was expected, however long or odd what came was.
inline void requireClearLine(const std::string& message) {
  constexpr std::size_t kLongest = 8000;
  const bool is_line = std::none_of(message.begin(), message.end(),
                                    [](unsigned char letter) { return std::iscntrl(letter) != 0; });
  if (!is_line || message.size() > kLongest || message.find("; expected ") == std::string::npos) {
    throw std::logic_error("not one clear line: " + message);
  }
}

/// What a reader made of some bytes: empty if it took them, else its Error. Any other exception is a fault of
/// ours, and goes on to the caller.
template <class Error, class Read>
std::string outcomeOf(Read read) {
  try {
    read();
    return "";
  } catch (const Error& error) {
    requireClearLine(error.what());
    return error.what();
  }
}

/// A law that holds whatever was read.
inline void require(bool holds, const char* law) {
  if (!holds) throw std::logic_error(std::string("broken: ") + law);
}

}  // namespace shallow_sand
