#include "feed_files.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  shallow_sand::feedScene(data, size);
  return 0;
}
