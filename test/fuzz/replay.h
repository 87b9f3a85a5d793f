#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace shallow_sand {

/// Reads every file that fuzzing found worth keeping, by the way the fuzzer read it.
template <class Feed>
void replay(const std::string& subject, Feed feed) {
  std::size_t files = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(SHALLOW_SAND_SOURCE_DIR "/test/fuzz/corpus/" + subject)) {
    std::ifstream file(entry.path(), std::ios::binary);
    const std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(file),
                                          std::istreambuf_iterator<char>()};
    EXPECT_NO_THROW(feed(bytes.data(), bytes.size())) << entry.path();
    ++files;
  }
  EXPECT_GT(files, 0u);
}

}  // namespace shallow_sand
