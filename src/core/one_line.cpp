#include "shallow_sand/core/one_line.h"

#include <algorithm>
#include <cctype>

namespace shallow_sand {
namespace {

constexpr std::size_t kLongest = 2000;
constexpr std::size_t kBeginning = 1200;
constexpr std::size_t kEnd = 600;

/// The last place up to `at` that is not within a letter of UTF-8.
std::size_t betweenLetters(const std::string& text, std::size_t at) {
  const std::size_t longest_letter = 4;
  std::size_t begin = at;
  while (begin > 0 && at - begin < longest_letter && (text[begin] & '\xc0') == '\x80') --begin;
  return begin;
}

}  // namespace

std::string oneLine(std::string text) {
  if (text.size() > kLongest) {
    const std::size_t beginning = betweenLetters(text, kBeginning);
    const std::size_t end = betweenLetters(text, text.size() - kEnd);
    text = text.substr(0, beginning) + "... (" + std::to_string(end - beginning) + " bytes) ..." +
           text.substr(end);
  }
  std::replace_if(
      text.begin(), text.end(), [](unsigned char letter) { return std::iscntrl(letter) != 0; }, ' ');
  return text;
}

}  // namespace shallow_sand
