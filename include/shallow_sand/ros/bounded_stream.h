#pragma once

#include <ros/serialization.h>

#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "shallow_sand/core/parameters.h"

namespace shallow_sand {

/// Reads messages as roscpp does, but allocates nothing for a list before it knows that its items are there.
/// @throws std::out_of_range at the end
class BoundedStream {
 public:
  BoundedStream(const std::uint8_t* data, std::size_t size) : data_(data), left_(size) {}

  template <class Message>
  Message take() {
    Message message;
    next(message);
    return message;
  }
  std::size_t left() const { return left_; }

  template <class Value>
  void next(Value& value) {
    if constexpr (std::is_arithmetic_v<Value>) {
      std::memcpy(&value, advance(sizeof value), sizeof value);
    } else {
      ros::serialization::Serializer<Value>::read(*this, value);
    }
  }
  void next(std::string& text) {
    const std::uint32_t size = take<std::uint32_t>();
    text.assign(reinterpret_cast<const char*>(advance(size)), size);
  }
  template <class Item>
  void next(std::vector<Item>& items) {
    const std::uint32_t size = take<std::uint32_t>();
    if (size > left_) throw std::out_of_range("a list is longer than its message");
    items.resize(size);
    for (Item& item : items) next(item);
  }

 private:
  const std::uint8_t* advance(std::size_t bytes) {
    if (bytes > left_) throw std::out_of_range("the message has ended");
    left_ -= bytes;
    const std::uint8_t* here = data_;
    data_ += bytes;
    return here;
  }

  const std::uint8_t* data_;
  std::size_t left_;
};

/// @throws std::exception if the bytes, which may be anything, are not those of a whole message
template <class Message>
Message readMessage(const std::vector<std::uint8_t>& bytes) {
  BoundedStream stream(bytes.data(), bytes.size());
  Message message = stream.take<Message>();
  if (stream.left() == 0) return message;
  throw InvalidParameter("request", std::to_string(stream.left()) + " bytes too many",
                         "the message of such a request");
}

}  // namespace shallow_sand
