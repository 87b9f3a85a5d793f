#include "shallow_sand/device/host_executor.h"

#ifdef __linux__
#include <sys/mman.h>
#endif

#include <cstdint>
#include <new>

namespace shallow_sand {

FieldMemory::FieldMemory(std::size_t bytes) {
  constexpr std::size_t kLine = 64;
  constexpr std::size_t kPage = 4096;
  constexpr std::size_t kHugePage = std::size_t{2} << 20;
  // Fields of a large map span more small pages than a CPU can look up.
  const std::size_t alignment = bytes < kHugePage ? kPage : kHugePage;
  const std::size_t size = (bytes + kPage + alignment - 1) / alignment * alignment;
  block_.reset(std::aligned_alloc(alignment, size));
  if (!block_) throw std::bad_alloc();
#ifdef __linux__
  // Only advice: what happens where it is not taken is slower, and not wrong.
  if (alignment == kHugePage) madvise(block_.get(), size, MADV_HUGEPAGE);
#endif
  // Several fields are read side by side. If all began at the same place of a page, each of their rows would
  // need the same few lines of a cache.
  const auto address = reinterpret_cast<std::uintptr_t>(block_.get());
  const std::uintptr_t line = 1 + (9 * (address / kPage + address / kHugePage)) % (kPage / kLine - 1);
  begin_ = static_cast<char*>(block_.get()) + line * kLine;
}

}  // namespace shallow_sand
