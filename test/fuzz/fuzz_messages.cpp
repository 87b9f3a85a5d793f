#include "feed_messages.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  shallow_sand::feedMessages(data, size);
  return 0;
}
