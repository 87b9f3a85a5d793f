#include "feed_parameters.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  shallow_sand::feedParameters(data, size);
  return 0;
}
