// Writes an uncompressed OpenEXR file from all ranks: the header gives every pixel a place, rank 0
// writes it with the table of rows, then each rank its ranges, whole rows some at a time and pieces
// of rows channel by channel. The file gets its name when all have written.
#include "composite/write_parts.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "comm/agree_on_failure.h"
#include "comm/collectives.h"
#include "composite/image_layer.h"
#include "composite/schemes/range.h"
#include "files/atomic_file.h"
#include "files/error.h"
#include "image/srgb.h"

namespace delray::composite {
namespace {

// In the order of a scan line, which OpenEXR wants to be that of the alphabet.
constexpr std::array<char, 5> kChannels = {'A', 'B', 'G', 'R', 'Z'};
constexpr std::uint64_t kRowsAtOnce = 64;  // some hundred kilobytes

// Grows by what is appended, little endian.
class Bytes {
 public:
  template <class T>
  Bytes& put(const T& value) {
    const auto* from = reinterpret_cast<const char*>(&value);
    bytes_.insert(bytes_.end(), from, from + sizeof value);
    return *this;
  }
  Bytes& text(const char* value) {
    bytes_.insert(bytes_.end(), value, value + std::strlen(value) + 1);
    return *this;
  }
  template <class T>
  Bytes& attribute(const char* name, const char* type, const T& value) {
    return text(name).text(type).put(static_cast<std::int32_t>(sizeof value)).put(value);
  }
  const std::vector<char>& all() const { return bytes_; }

 private:
  std::vector<char> bytes_;
};

// Where everything is in the file.
struct Layout {
  std::uint64_t width, height, header_bytes = 0;

  std::uint64_t plane_bytes() const { return width * sizeof(float); }
  std::uint64_t row_bytes() const { return 8 + kChannels.size() * plane_bytes(); }
  std::uint64_t row(std::uint64_t y) const { return header_bytes + 8 * height + y * row_bytes(); }
  std::uint64_t value(std::uint64_t x, std::uint64_t y, std::size_t channel) const {
    return row(y) + 8 + channel * plane_bytes() + x * sizeof(float);
  }
};

std::vector<char> header(const Layout& layout) {
  Bytes bytes;
  bytes.put(std::int32_t{20000630}).put(std::int32_t{2});
  constexpr std::size_t kBytesOfChannel = 18;
  bytes.text("channels").text("chlist");
  bytes.put(static_cast<std::int32_t>(kChannels.size() * kBytesOfChannel + 1));
  for (const char channel : kChannels) {
    const std::array<char, 2> name = {channel, 0};
    constexpr std::int32_t kFloat = 2, kLinear = 0, kEveryPixel = 1;
    bytes.text(name.data()).put(kFloat).put(kLinear).put(kEveryPixel).put(kEveryPixel);
  }
  bytes.put(char{0});
  const std::array<std::int32_t, 4> window = {0, 0, static_cast<std::int32_t>(layout.width) - 1,
                                              static_cast<std::int32_t>(layout.height) - 1};
  bytes.attribute("compression", "compression", char{0});
  bytes.attribute("dataWindow", "box2i", window).attribute("displayWindow", "box2i", window);
  bytes.attribute("lineOrder", "lineOrder", char{0});
  bytes.attribute("pixelAspectRatio", "float", 1.0F);
  bytes.attribute("screenWindowCenter", "v2f", std::array<float, 2>{});
  bytes.attribute("screenWindowWidth", "float", 1.0F);
  bytes.put(char{0});
  return bytes.all();
}

class File {
 public:
  File(const std::filesystem::path& path, int flags)
      : path_(path), descriptor_(::open(path.c_str(), flags | O_CLOEXEC, 0666)) {
    if (descriptor_ < 0) fail();
  }
  ~File() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  void write(std::span<const char> bytes, std::uint64_t at) const {
    while (!bytes.empty()) {
      const ssize_t written =
          ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(at));
      if (written < 0 && errno == EINTR) continue;
      if (written <= 0) fail();
      bytes = bytes.subspan(static_cast<std::size_t>(written));
      at += static_cast<std::uint64_t>(written);
    }
  }
  // Disks that are full are found out about here at the latest.
  void close() {
    if (::close(std::exchange(descriptor_, -1)) != 0) fail();
  }

 private:
  [[noreturn]] void fail() const {
    throw files::FileError(files::Cause::device, path_.string(), "", std::strerror(errno));
  }
  std::filesystem::path path_;
  int descriptor_;
};

void set(const image::RgbaF& colour, float depth, std::array<float, 5>& values) {
  values = {colour.a, colour.b, colour.g, colour.r, depth};
}
void set(const image::Rgba8& colour, float depth, std::array<float, 5>& values) {
  set(image::to_float(colour), depth, values);
}

// Pixels [x0, x1) of a row as planes of `to`, which has so many values between them.
template <class Colour>
void put_planes(const image::BasicImage<Colour>& image, std::uint64_t first, std::uint64_t size,
                char* to) {
  std::array<float, 5> values;
  for (std::uint64_t i = 0; i < size; ++i) {
    set(image.colour[first + i], image.depth[first + i], values);
    for (std::size_t channel = 0; channel < values.size(); ++channel) {
      std::memcpy(to + (channel * size + i) * sizeof(float), &values[channel], sizeof(float));
    }
  }
}

template <class Colour>
void write_range(const File& file, const Layout& layout, const image::BasicImage<Colour>& image,
                 PixelRange range) {
  std::vector<char> bytes;
  const auto put_row = [&](std::uint64_t y) {
    const auto number = static_cast<std::int32_t>(y);
    const auto size = static_cast<std::int32_t>(layout.row_bytes() - 8);
    const std::size_t at = bytes.size();
    bytes.resize(at + layout.row_bytes());
    std::memcpy(bytes.data() + at, &number, sizeof number);
    std::memcpy(bytes.data() + at + 4, &size, sizeof size);
    put_planes(image, y * layout.width, layout.width, bytes.data() + at + 8);
  };
  const auto write_piece = [&](std::uint64_t y, PixelRange piece) {
    const std::uint64_t x = piece.begin - y * layout.width, size = piece.size() * sizeof(float);
    bytes.resize(kChannels.size() * size);
    put_planes(image, piece.begin, piece.size(), bytes.data());
    for (std::size_t channel = 0; channel < kChannels.size(); ++channel) {
      file.write(std::span<const char>(bytes).subspan(channel * size, size),
                 layout.value(x, y, channel));
    }
    if (x > 0) return;
    const std::array<std::int32_t, 2> head = {static_cast<std::int32_t>(y),
                                              static_cast<std::int32_t>(layout.row_bytes() - 8)};
    file.write({reinterpret_cast<const char*>(head.data()), sizeof head}, layout.row(y));
  };
  for (std::uint64_t y = range.begin / layout.width; y * layout.width < range.end;) {
    const PixelRange row{y * layout.width, (y + 1) * layout.width};
    const PixelRange piece = internal::overlap(range, row);
    bytes.clear();
    if (piece != row) {
      write_piece(y++, piece);
      continue;
    }
    const std::uint64_t first = y;
    for (; y < first + kRowsAtOnce && (y + 1) * layout.width <= range.end; ++y) put_row(y);
    file.write(bytes, layout.row(first));
  }
}

void write_header(const Layout& layout, const std::vector<char>& start, const File& file) {
  file.write(start, 0);
  std::vector<std::uint64_t> rows;
  for (std::uint64_t y = 0; y < layout.height; ++y) rows.push_back(layout.row(y));
  file.write({reinterpret_cast<const char*>(rows.data()), rows.size() * sizeof rows[0]},
             start.size());
}

template <class Colour>
void write_image_parts(comm::Communicator& communicator, const OwnedPixels& part,
                       const image::BasicImage<Colour>& image, const std::filesystem::path& path) {
  if (image.width < 1 || image.height < 1)
    throw std::invalid_argument("a picture has at least one pixel");
  Layout layout{static_cast<std::uint64_t>(image.width), static_cast<std::uint64_t>(image.height)};
  const std::vector<char> start = header(layout);
  layout.header_bytes = start.size();
  std::unique_ptr<files::AtomicFile> whole;  // on rank 0
  std::string name;
  comm::all_or_none(communicator, comm::Phase::other, [&] {
    if (communicator.rank() != 0) return;
    whole = std::make_unique<files::AtomicFile>(path);
    name = whole->temporary().string();
    File file(name, O_WRONLY | O_NOFOLLOW);
    write_header(layout, start, file);
    file.close();
  });
  const comm::Buffer told =
      comm::broadcast(communicator, 0, comm::Buffer::of(std::span<const char>(name)));
  name.assign(told.as<char>().begin(), told.as<char>().end());
  comm::all_or_none(communicator, comm::Phase::other, [&] {
    File file(name, O_WRONLY | O_NOFOLLOW);
    for (const PixelRange& range : part.ranges) write_range(file, layout, image, range);
    file.close();
  });
  comm::all_or_none(communicator, comm::Phase::other, [&] {
    if (whole != nullptr) whole->commit();
  });
}

}  // namespace

void write_parts(comm::Communicator& communicator, const OwnedPixels& part,
                 const std::filesystem::path& path) {
  if (const auto* layer = dynamic_cast<const ImageLayer<image::Rgba8>*>(part.layer.get())) {
    write_image_parts(communicator, part, layer->image(), path);
  } else {
    write_image_parts(communicator, part,
                      dynamic_cast<const ImageLayer<image::RgbaF>&>(*part.layer).image(), path);
  }
}

}  // namespace delray::composite
