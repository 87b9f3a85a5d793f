#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>

#include "random_seed.h"
#include "shallow_sand/core/one_line.h"
#include "shallow_sand/core/parameters.h"

namespace shallow_sand {
namespace {

TEST(OneLine, LeavesLinesAsTheyAre) {
  for (const std::string& text :
       {std::string(), std::string("grid.size[0]: 0"), std::string("a \xc3\xa4 b"), std::string(2000, 'x')})
    EXPECT_EQ(oneLine(text), text);
}

TEST(OneLine, OfAnyTextIsAShortLineThatBeginsAndEndsAlike) {
  std::mt19937 random = seededGenerator();
  for (int trial = 0; trial < 50; ++trial) {
    std::string text(random() % 10000, ' ');
    for (char& letter : text) letter = static_cast<char>(random());
    const std::string line = oneLine(text);
    EXPECT_LE(line.size(), 2000u);
    EXPECT_TRUE(std::none_of(line.begin(), line.end(), [](unsigned char c) { return std::iscntrl(c) != 0; }));
    const auto blank = [](unsigned char c) { return std::iscntrl(c) != 0 ? ' ' : static_cast<char>(c); };
    std::transform(text.begin(), text.end(), text.begin(), blank);
    const std::size_t same = std::min<std::size_t>(text.size(), 500);
    EXPECT_EQ(line.substr(0, same), text.substr(0, same));
    EXPECT_EQ(line.substr(line.size() - same), text.substr(text.size() - same));
  }
}

TEST(OneLine, CutsNoLetterOfUtf8) {
  std::mt19937 random = seededGenerator();
  for (int trial = 0; trial < 50; ++trial) {
    std::string text;
    while (text.size() < 3000) text += random() % 2 == 0 ? "\xe6\xb2\x99" : "x";
    const std::string line = oneLine(text);
    std::size_t begins = 0;
    std::size_t continues = 0;
    for (const unsigned char letter : line) {
      begins += letter == 0xe6 ? 1 : 0;
      continues += (letter & 0xc0) == 0x80 ? 1 : 0;
    }
    EXPECT_EQ(continues, 2 * begins) << line;
  }
}

TEST(OneLine, IsWhatAnErrorIs) {
  const std::string name = std::string(1000000, 'x') + "\n";
  const std::string message = InvalidParameter(name, name, name).what();
  EXPECT_LT(message.size(), 7000u);
  EXPECT_EQ(message.find('\n'), std::string::npos);
  EXPECT_NE(message.find("; expected "), std::string::npos);
}

}  // namespace
}  // namespace shallow_sand
