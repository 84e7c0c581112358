// Values one after the other in a message.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

#include "comm/bad_message.h"
#include "comm/buffer.h"

namespace delray::delaunay {

class Packer {
 public:
  template <class T>
  Packer& value(const T& value) {
    return bytes_of(std::span<const T>(&value, 1));
  }
  // The number of values, then the values.
  template <class T>
  Packer& list(std::span<const T> values) {
    value(static_cast<std::uint64_t>(values.size()));
    return bytes_of(values);
  }
  template <class T>
  Packer& list(const std::vector<T>& values) {
    return list(std::span<const T>(values));
  }
  comm::Buffer buffer() const { return comm::Buffer::of(std::span<const std::byte>(bytes_)); }

 private:
  template <class T>
  Packer& bytes_of(std::span<const T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    const auto* first = reinterpret_cast<const std::byte*>(values.data());
    bytes_.insert(bytes_.end(), first, first + values.size_bytes());
    return *this;
  }
  std::vector<std::byte> bytes_;
};

// Throws comm::BadMessage where a message ends too early.
class Unpacker {
 public:
  explicit Unpacker(const comm::Buffer& message) : message_(message) {}

  template <class T>
  T value() {
    static_assert(std::is_trivially_copyable_v<T>);
    T result;
    comm::check_message(message_.size() - at_ >= sizeof(T));
    std::memcpy(&result, message_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    return result;
  }
  template <class T>
  std::vector<T> list() {
    const auto count = value<std::uint64_t>();
    comm::check_message(count <= (message_.size() - at_) / sizeof(T));
    std::vector<T> result(count);
    if (count > 0) std::memcpy(result.data(), message_.data() + at_, count * sizeof(T));
    at_ += count * sizeof(T);
    return result;
  }

 private:
  const comm::Buffer& message_;
  std::size_t at_ = 0;
};

}  // namespace delray::delaunay
