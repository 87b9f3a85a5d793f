#pragma once

#include <ros/serialization.h>

#include <cstdint>
#include <memory>
#include <new>
#include <string>
#include <vector>

#include "shallow_sand/core/parameters.h"

namespace shallow_sand {

/// For messages that are read from bytes which may be anything: no part takes much more memory than bytes of
/// a small message can fill, whatever length it claims.
template <class T>
struct BoundedAllocator : std::allocator<T> {
  static constexpr std::size_t kMost = 1 << 20;  ///< [bytes]

  template <class Other>
  struct rebind {
    using other = BoundedAllocator<Other>;
  };
  BoundedAllocator() = default;
  template <class Other>
  BoundedAllocator(const BoundedAllocator<Other>&) {}
  T* allocate(std::size_t count) {
    if (count > kMost / sizeof(T)) throw std::bad_alloc();
    return std::allocator<T>::allocate(count);
  }
};

template <class Message>
struct Bounded;
template <template <class> class Message, class Allocator>
struct Bounded<Message<Allocator>> {
  using Type = Message<BoundedAllocator<void>>;
};

template <class Message>
Message readAll(std::vector<std::uint8_t>& bytes) {
  Message message;
  ros::serialization::IStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::deserialize(stream, message);
  if (stream.getLength() == 0) return message;
  throw InvalidParameter("request", std::to_string(stream.getLength()) + " bytes too many",
                         "the message of such a request");
}

/// @throws std::exception if the bytes are not those of a whole message
template <class Message>
Message boundedRead(std::vector<std::uint8_t> bytes) {
  readAll<typename Bounded<Message>::Type>(bytes);
  return readAll<Message>(bytes);
}

}  // namespace shallow_sand
