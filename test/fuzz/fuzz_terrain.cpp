#include <algorithm>
#include <cctype>
#include <functional>

#include "feed_files.h"

namespace {

/// GDAL is not built for fuzzing. What comes out of it counts as coverage instead.
__attribute__((section("__libfuzzer_extra_counters"))) std::uint8_t counters[4096];

/// What is left of an error without the numbers and names of the file.
std::string kindOf(std::string text) {
  const std::size_t end = text.find("; expected ");
  if (end != std::string::npos) {
    text.erase(end);
    text.erase(0, text.rfind(": "));
    text.erase(std::remove_if(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c) != 0; }),
               text.end());
  }
  return text;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  for (const std::string& outcome : shallow_sand::feedTerrain(data, size)) {
    counters[std::hash<std::string>()(kindOf(outcome)) % sizeof(counters)] = 1;
  }
  return 0;
}
