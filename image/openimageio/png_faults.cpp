// Reads chunks, their checksums and the rows of pixels as the PNG specification (ISO/IEC 15948) has
// them, without making a picture of them.
#include "image/openimageio/png_faults.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace delray::image::openimageio {
namespace {

using Bytes = std::vector<std::uint8_t>;

struct Fault {
  const char* what;
};

constexpr std::uint64_t kSignature = 8;
constexpr std::uint32_t kMostLength = 0x7FFFFFFF;
constexpr std::uint32_t kMostSide = 1000000;  // of libpng
constexpr std::size_t kBlock = 1 << 16;

std::uint32_t number_at(const std::uint8_t* bytes) {
  return std::uint32_t{bytes[0]} << 24 | std::uint32_t{bytes[1]} << 16 |
         std::uint32_t{bytes[2]} << 8 | bytes[3];
}

// The chunks of a file, one after the other.
class Chunks {
 public:
  explicit Chunks(OIIO::Filesystem::IOProxy& file) : file_(file) {}

  void next() {
    std::array<std::uint8_t, 8> header{};
    take(header.data(), header.size());
    left_ = length_ = number_at(header.data());
    if (length_ > kMostLength) throw Fault{"a part of it claims an impossible length"};
    kind_.assign(reinterpret_cast<const char*>(header.data() + 4), 4);
    checksum_ = crc32(crc32(0, nullptr, 0), header.data() + 4, 4);
  }
  std::string_view kind() const { return kind_; }
  std::uint32_t length() const { return length_; }
  bool is_critical() const { return (kind_[0] & 0x20) == 0; }

  // Up to so many of the bytes that are left of the chunk.
  std::size_t read(std::uint8_t* to, std::size_t most) {
    const std::size_t size = std::min<std::size_t>(most, left_);
    take(to, size);
    checksum_ = crc32(checksum_, to, static_cast<uInt>(size));
    left_ -= static_cast<std::uint32_t>(size);
    return size;
  }

  // Goes on behind the chunk. Others than critical ones are left out where they are damaged.
  void finish() {
    if (!is_critical()) {
      offset_ += std::uint64_t{left_} + 4;
      return;
    }
    Bytes rest(std::min<std::size_t>(kBlock, left_));
    while (left_ > 0) read(rest.data(), rest.size());
    std::array<std::uint8_t, 4> checksum{};
    take(checksum.data(), checksum.size());
    if (number_at(checksum.data()) != checksum_) throw Fault{"a checksum is wrong"};
  }

 private:
  void take(std::uint8_t* to, std::size_t size) {
    if (size > 0 && file_.pread(to, size, static_cast<std::int64_t>(offset_)) != size) {
      throw Fault{"it ends early"};
    }
    offset_ += size;
  }

  OIIO::Filesystem::IOProxy& file_;
  std::uint64_t offset_ = kSignature;
  std::uint32_t length_ = 0, left_ = 0;
  std::string kind_;
  uLong checksum_ = 0;
};

struct Header {
  std::uint32_t width = 0, height = 0;
  std::uint32_t bits_per_pixel = 0;
  bool palette = false, interlaced = false;
};

// Values of a pixel by the kind of colour; 0: there is no such kind.
constexpr std::uint32_t kValues[] = {1, 0, 3, 1, 2, 0, 4};
constexpr std::uint8_t kPalette = 3;

Header read_header(Chunks& chunks) {
  chunks.next();
  std::array<std::uint8_t, 13> data{};
  if (chunks.kind() != "IHDR" || chunks.length() != data.size()) throw Fault{"it has no header"};
  chunks.read(data.data(), data.size());
  chunks.finish();
  const std::uint8_t bits = data[8], colour = data[9];
  const Header header{number_at(data.data()), number_at(data.data() + 4),
                      colour < std::size(kValues) ? kValues[colour] * bits : 0, colour == kPalette,
                      data[12] == 1};
  if (header.width == 0 || header.height == 0) throw Fault{"it has no pixels"};
  if (header.width > kMostSide || header.height > kMostSide) throw Fault{"its size is impossible"};
  const bool whole = bits == 8 || (bits == 16 && !header.palette);
  const bool packed = (bits == 1 || bits == 2 || bits == 4) && (colour == 0 || header.palette);
  if (header.bits_per_pixel == 0 || !(whole || packed) || data[10] != 0 || data[11] != 0 ||
      data[12] > 1) {
    throw Fault{"its pixels are of an unknown kind"};
  }
  return header;
}

// Ends in the first chunk of pixels.
void find_pixels(Chunks& chunks, const Header& header) {
  bool palette = false;
  for (chunks.next(); chunks.kind() != "IDAT"; chunks.next()) {
    if (chunks.kind() == "IEND") throw Fault{"it has no pixels"};
    if (chunks.kind() == "PLTE") {
      palette = chunks.length() % 3 == 0 && chunks.length() > 0 && chunks.length() <= 3 * 256;
    } else if (chunks.is_critical()) {
      throw Fault{"a part of it is of an unknown kind"};
    }
    chunks.finish();
  }
  if (header.palette && !palette) throw Fault{"it has no palette"};
}

class Unpacked {
 public:
  explicit Unpacked(Chunks& chunks) : chunks_(chunks), packed_(kBlock) { inflateInit(&stream_); }
  ~Unpacked() { inflateEnd(&stream_); }
  Unpacked(const Unpacked&) = delete;
  Unpacked& operator=(const Unpacked&) = delete;

  void read(Bytes& row) {
    stream_.next_out = row.data();
    stream_.avail_out = static_cast<uInt>(row.size());
    while (stream_.avail_out > 0) {
      if (stream_.avail_in == 0) fetch();
      const int result = inflate(&stream_, Z_NO_FLUSH);
      if (result == Z_STREAM_END && stream_.avail_out > 0) throw Fault{"it lacks pixels"};
      if (result != Z_OK && result != Z_STREAM_END) throw Fault{"its pixels cannot be unpacked"};
    }
  }

 private:
  void fetch() {
    std::size_t size = chunks_.read(packed_.data(), packed_.size());
    while (size == 0) {
      chunks_.finish();
      chunks_.next();
      if (chunks_.kind() != "IDAT") throw Fault{"it lacks pixels"};
      size = chunks_.read(packed_.data(), packed_.size());
    }
    stream_.next_in = packed_.data();
    stream_.avail_in = static_cast<uInt>(size);
  }

  Chunks& chunks_;
  Bytes packed_;
  z_stream stream_{};
};

void read_rows(Unpacked& unpacked, std::uint32_t width, std::uint32_t height,
               std::uint32_t bits_per_pixel) {
  constexpr std::uint8_t kFilters = 5;
  if (width == 0) return;
  Bytes row(1 + (std::uint64_t{width} * bits_per_pixel + 7) / 8);
  for (std::uint32_t y = 0; y < height; ++y) {
    unpacked.read(row);
    if (row[0] >= kFilters) throw Fault{"a row of pixels is of an unknown kind"};
  }
}

void read_pixels(Chunks& chunks, const Header& header) {
  Unpacked unpacked(chunks);
  if (!header.interlaced) {
    return read_rows(unpacked, header.width, header.height, header.bits_per_pixel);
  }
  struct Pass {
    std::uint32_t x, y, step_x, step_y;
  };
  constexpr Pass kAdam7[] = {{0, 0, 8, 8}, {4, 0, 8, 8}, {0, 4, 4, 8}, {2, 0, 4, 4},
                             {0, 2, 2, 4}, {1, 0, 2, 2}, {0, 1, 1, 2}};
  for (const Pass& pass : kAdam7) {
    read_rows(unpacked, (header.width + pass.step_x - 1 - pass.x) / pass.step_x,
              (header.height + pass.step_y - 1 - pass.y) / pass.step_y, header.bits_per_pixel);
  }
}

std::string fault_of(OIIO::Filesystem::IOProxy& file, bool with_pixels) {
  try {
    Chunks chunks(file);
    const Header header = read_header(chunks);
    find_pixels(chunks, header);
    if (with_pixels) {
      read_pixels(chunks, header);
      chunks.finish();
    }
    return {};
  } catch (const Fault& fault) {
    return fault.what;
  }
}

}  // namespace

std::string png_header_fault(OIIO::Filesystem::IOProxy& file) { return fault_of(file, false); }

std::string png_pixels_fault(OIIO::Filesystem::IOProxy& file) { return fault_of(file, true); }

}  // namespace delray::image::openimageio
