// Plain values as little-endian bytes, and back.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "files/error.h"

namespace delray::packs::internal {

static_assert(std::endian::native == std::endian::little);

// Both have the same operators, so that one list of fields serves writing and reading.
class ByteWriter {
 public:
  static constexpr bool kReads = false;

  template <class T>
  void value(const T& v) {
    static_assert(std::is_trivially_copyable_v<T>);
    raw(&v, sizeof v);
  }
  void flag(const bool& v) { value(static_cast<std::uint8_t>(v)); }
  template <class E>
  void choice(const E& v, E /*last*/) {
    value(static_cast<std::uint8_t>(v));
  }
  void text(const std::string& v) {
    value(static_cast<std::uint64_t>(v.size()));
    raw(v.data(), v.size());
  }
  template <class T>
  void array(const std::vector<T>& v) {
    value(static_cast<std::uint64_t>(v.size()));
    raw(v.data(), v.size() * sizeof(T));
  }
  void raw(const void* from, std::size_t size) {
    const auto* bytes = static_cast<const char*>(from);
    bytes_.insert(bytes_.end(), bytes, bytes + size);
  }
  std::vector<char>& bytes() { return bytes_; }

 private:
  std::vector<char> bytes_;
};

// Throws FileError (input), which names the file and the place, where the bytes end too early.
class ByteReader {
 public:
  static constexpr bool kReads = true;

  // Refers to the strings.
  ByteReader(std::span<const char> bytes, std::string_view file, std::string_view place)
      : bytes_(bytes), file_(file), place_(place) {}

  template <class T>
  void value(T& v) {
    static_assert(std::is_trivially_copyable_v<T>);
    std::memcpy(static_cast<void*>(&v), take(sizeof v).data(), sizeof v);
  }
  void flag(bool& v) {
    std::uint8_t byte = 0;
    value(byte);
    if (byte > 1) fail("a flag is neither 0 nor 1");
    v = byte == 1;
  }
  template <class E>
  void choice(E& v, E last) {
    std::uint8_t byte = 0;
    value(byte);
    if (byte > static_cast<std::uint8_t>(last)) fail("there is no choice of that number");
    v = static_cast<E>(byte);
  }
  void text(std::string& v) {
    const std::span<const char> from = take(count(1));
    v.assign(from.begin(), from.end());
  }
  template <class T>
  void array(std::vector<T>& v) {
    static_assert(std::is_trivially_copyable_v<T>);
    v.resize(count(sizeof(T)));
    const std::span<const char> from = take(v.size() * sizeof(T));
    if (!from.empty()) std::memcpy(static_cast<void*>(v.data()), from.data(), from.size());
  }
  // A number of things of which each takes so many bytes at least: there cannot be more.
  std::size_t count(std::size_t bytes_each) {
    std::uint64_t n = 0;
    value(n);
    if (n > bytes_.size() / bytes_each) fail("a count is larger than what follows");
    return n;
  }
  std::span<const char> take(std::size_t size) {
    if (size > bytes_.size()) fail("it ends too early");
    const std::span<const char> taken = bytes_.first(size);
    bytes_ = bytes_.subspan(size);
    return taken;
  }
  std::size_t left() const { return bytes_.size(); }
  bool at_end() const { return bytes_.empty(); }
  [[noreturn]] void fail(const std::string& what) const {
    throw files::FileError(files::Cause::input, std::string(file_), std::string(place_), what);
  }

 private:
  std::span<const char> bytes_;
  std::string_view file_, place_;
};

}  // namespace delray::packs::internal
