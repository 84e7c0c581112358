// Several messages as one.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <utility>

#include "comm/bad_message.h"
#include "comm/buffer.h"

namespace delray::composite {

constexpr std::size_t padded_to_8(std::size_t bytes) { return (bytes + 7) / 8 * 8; }

// The messages one after the other, each behind its size and padded to 8 bytes.
inline comm::Buffer bundle(std::span<const comm::Buffer> messages) {
  std::size_t bytes = 0, counted = 0;
  for (const comm::Buffer& message : messages) {
    bytes += sizeof(std::uint64_t) + padded_to_8(message.size());
    counted += sizeof(std::uint64_t) + padded_to_8(message.counted_bytes());
  }
  comm::Buffer result(bytes);
  std::byte* to = result.data();
  for (const comm::Buffer& message : messages) {
    const std::uint64_t size = message.size();
    std::memcpy(to, &size, sizeof size);
    to += sizeof size;
    if (size > 0) std::memcpy(to, message.data(), size);
    std::memset(to + size, 0, padded_to_8(size) - size);
    to += padded_to_8(size);
  }
  return comm::Buffer::standing_for(counted, std::move(result));
}

// Takes a bundle apart. Throws comm::BadMessage where it ends too early, or goes on.
class Unbundling {
 public:
  explicit Unbundling(const comm::Buffer& bundle) : left_(bundle.data(), bundle.size()) {}

  comm::Buffer next() {
    std::uint64_t size = 0;
    comm::check_message(sizeof size <= left_.size());
    std::memcpy(&size, left_.data(), sizeof size);
    left_ = left_.subspan(sizeof size);
    comm::check_message(size <= left_.size());
    comm::Buffer message = comm::Buffer::of(left_.first(size));
    left_ = left_.subspan(std::min(padded_to_8(size), left_.size()));
    return message;
  }
  // After the last one.
  void check_end() const { comm::check_message(left_.empty()); }

 private:
  std::span<const std::byte> left_;
};

}  // namespace delray::composite
