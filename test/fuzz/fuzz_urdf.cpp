#include "feed_urdf.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  shallow_sand::feedUrdf(data, size);
  return 0;
}
