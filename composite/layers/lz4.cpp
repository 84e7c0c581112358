// Compresses the message of an active layer in blocks, in parallel: differences between successive
// 32-bit values, their bytes sorted by significance, then LZ4. A block that does not become smaller
// travels as it is. Degenerate: a message that declares more bytes than LZ4 could have compressed
// into it is refused before memory is taken.
#include "composite/layers/lz4.h"

#include <lz4.h>

#include <algorithm>
#include <cstring>
#include <vector>

#include "comm/bad_message.h"
#include "parallel/parallel_for.h"

namespace delray::composite {
namespace {

constexpr std::size_t kBlock = std::size_t{1} << 20;
constexpr std::size_t kMostOfByte = 255;  // that a compressed byte may stand for

std::size_t blocks_of(std::size_t bytes) { return (bytes + kBlock - 1) / kBlock; }

// Byte j of every value goes to the j-th quarter of `to`; values are differences to the one before,
// of their bits. `from` has `size` bytes, the last of which may be no whole value.
void sort_bytes(const std::byte* from, std::size_t size, std::byte* to) {
  const std::size_t values = size / 4;
  std::uint32_t last = 0;
  for (std::size_t i = 0; i < values; ++i) {
    std::uint32_t value = 0;
    std::memcpy(&value, from + 4 * i, sizeof value);
    const std::uint32_t difference = value - last;
    last = value;
    for (std::size_t j = 0; j < 4; ++j) to[j * values + i] = std::byte(difference >> 8 * j & 255U);
  }
  std::copy(from + 4 * values, from + size, to + 4 * values);
}

void unsort_bytes(const std::byte* from, std::size_t size, std::byte* to) {
  const std::size_t values = size / 4;
  std::uint32_t last = 0;
  for (std::size_t i = 0; i < values; ++i) {
    std::uint32_t difference = 0;
    for (std::size_t j = 0; j < 4; ++j) {
      difference |= std::to_integer<std::uint32_t>(from[j * values + i]) << 8 * j;
    }
    last += difference;
    std::memcpy(to + 4 * i, &last, sizeof last);
  }
  std::copy(from + 4 * values, from + size, to + 4 * values);
}

struct Block {
  std::size_t begin, size;
};

Block block_at(std::size_t i, std::size_t bytes) {
  return {i * kBlock, std::min(kBlock, bytes - i * kBlock)};
}

comm::Buffer compress(const comm::Buffer& plain) {
  std::vector<std::vector<std::byte>> compressed(blocks_of(plain.size()));
  parallel::parallel_for(0, compressed.size(), 1, [&](std::size_t i) {
    const Block block = block_at(i, plain.size());
    std::vector<std::byte> sorted(block.size);
    sort_bytes(plain.data() + block.begin, block.size, sorted.data());
    compressed[i].resize(block.size);
    // 0 if that would not make it smaller.
    const int size = LZ4_compress_default(
        reinterpret_cast<const char*>(sorted.data()), reinterpret_cast<char*>(compressed[i].data()),
        static_cast<int>(block.size), static_cast<int>(block.size) - 1);
    if (size > 0) {
      compressed[i].resize(static_cast<std::size_t>(size));
    } else {
      std::copy_n(plain.data() + block.begin, block.size, compressed[i].data());
    }
  });
  std::size_t bytes = 0;
  for (const auto& block : compressed) bytes += sizeof(std::uint64_t) + block.size();
  comm::Buffer result(sizeof(std::uint64_t) + bytes);
  std::byte* to = result.data();
  const auto put = [&](std::uint64_t value) {
    std::memcpy(to, &value, sizeof value);
    to += sizeof value;
  };
  put(plain.size());
  for (const auto& block : compressed) put(block.size());
  for (const auto& block : compressed) to = std::copy(block.begin(), block.end(), to);
  return result;
}

comm::Buffer decompress(const comm::Buffer& message) {
  const std::byte* from = message.data();
  const auto rest = [&] {
    return message.size() - static_cast<std::size_t>(from - message.data());
  };
  const auto take = [&] {
    std::uint64_t value = 0;
    comm::check_message(rest() >= sizeof value);
    std::memcpy(&value, from, sizeof value);
    from += sizeof value;
    return value;
  };
  const std::uint64_t bytes = take();
  comm::check_message(bytes / kMostOfByte <= message.size());
  comm::Buffer plain(bytes);
  std::vector<std::size_t> begins(blocks_of(plain.size()) + 1);
  for (std::size_t i = 1; i < begins.size(); ++i) {
    const std::uint64_t size = take();
    comm::check_message(size <= block_at(i - 1, plain.size()).size);
    begins[i] = begins[i - 1] + size;
  }
  comm::check_message(begins.back() == rest());
  parallel::parallel_for(0, begins.size() - 1, 1, [&](std::size_t i) {
    const Block block = block_at(i, plain.size());
    const std::size_t size = begins[i + 1] - begins[i];
    if (size == block.size) {
      std::copy_n(from + begins[i], size, plain.data() + block.begin);
      return;
    }
    std::vector<std::byte> sorted(block.size);
    const int decompressed = LZ4_decompress_safe(
        reinterpret_cast<const char*>(from + begins[i]), reinterpret_cast<char*>(sorted.data()),
        static_cast<int>(size), static_cast<int>(block.size));
    comm::check_message(decompressed == static_cast<int>(block.size));
    unsort_bytes(sorted.data(), block.size, plain.data() + block.begin);
  });
  return plain;
}

}  // namespace

template <class Colour>
comm::Buffer Lz4Layer<Colour>::encode(PixelRange range) {
  return compress(ActiveLayer<Colour>::encode(range));
}

template <class Colour>
std::uint64_t Lz4Layer<Colour>::apply(PixelRange range, const comm::Buffer& pixels, Action action) {
  return ActiveLayer<Colour>::apply(range, decompress(pixels), action);
}

template class Lz4Layer<image::Rgba8>;
template class Lz4Layer<image::RgbaF>;

std::unique_ptr<Layer> make_lz4(image::Image8&& image, Operator how) {
  return std::make_unique<Lz4Layer<image::Rgba8>>(std::move(image), how);
}

std::unique_ptr<Layer> make_lz4(image::ImageF&& image, Operator how) {
  return std::make_unique<Lz4Layer<image::RgbaF>>(std::move(image), how);
}

}  // namespace delray::composite
