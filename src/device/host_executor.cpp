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
  const std::size_t size = bytes + kPage;
  // Of zeros that the system gives, a page takes up memory only once something is written there.
  block_.reset(std::calloc(1, size + alignment));
  if (!block_) throw std::bad_alloc();
  const auto address =
      (reinterpret_cast<std::uintptr_t>(block_.get()) + alignment - 1) / alignment * alignment;
#ifdef __linux__
  // Only advice: what happens where it is not taken is slower, and not wrong.
  if (alignment == kHugePage) madvise(reinterpret_cast<void*>(address), size, MADV_HUGEPAGE);
#endif
  // Several fields are read side by side. If all began at the same place of a page, each of their rows would
  // need the same few lines of a cache.
  const std::uintptr_t line = 1 + (9 * (address / kPage + address / kHugePage)) % (kPage / kLine - 1);
  begin_ = reinterpret_cast<void*>(address + line * kLine);
}

}  // namespace shallow_sand
