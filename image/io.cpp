// Pictures in files: chooses the format, buffers streams, replaces files atomically and makes alpha
// straight for formats that store it so. OpenImageIO is behind a codec that is loaded on first use;
// PNG files are encoded without it.
#include "image/io.h"

#include <dlfcn.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cctype>
#include <limits>

#include "files/atomic_file.h"
#include "files/error.h"
#include "files/format.h"
#include "files/read_file.h"
#include "image/openimageio/codec.h"
#include "image/picture_rows.h"
#include "image/srgb.h"

namespace delray::image {
namespace {

using openimageio::Codec;
using openimageio::Encoded;

constexpr std::array kSuffixes = {".exr", ".png", ".tif", ".tiff", ".jpg", ".jpeg"};

const Codec* load_codec() {
  using Entry = const Codec* (*)();
  // Never unloaded: what it brings starts threads.
  void* library = ::dlopen(openimageio::kLibrary, RTLD_LAZY | RTLD_LOCAL);
  void* entry = library ? ::dlsym(library, openimageio::kEntry) : nullptr;
  if (!entry) {
    throw files::FileError(files::Cause::device, openimageio::kLibrary, "",
                           std::string("cannot be loaded: ") + ::dlerror());
  }
  return reinterpret_cast<Entry>(entry)();
}

const Codec& codec() {
  static const Codec* const loaded = load_codec();
  return *loaded;
}

// A file, which the codec opens by its name, or the bytes of a stream.
class Content {
 public:
  enum class Stream : std::uint8_t { ends, stays };

  Content(const std::filesystem::path& path, const files::MemoryBudget& memory,
          Stream stream = Stream::ends)
      : encoded_{path.string(), std::nullopt, memory} {
    if (!files::is_stream(path)) return;
    // A stream of something else need not be read to its end, if it has one.
    if (files::identify_format(path, memory) != files::Format::image) {
      throw files::FileError(files::Cause::input, path.string(), "",
                             "is not a picture in a format that is known");
    }
    constexpr std::size_t kEverything = std::numeric_limits<std::size_t>::max();
    bytes_ = stream == Stream::ends ? files::read_file(path, memory)
                                    : files::read_start(path, kEverything, memory);
    encoded_.bytes = std::as_bytes(std::span(bytes_));
  }
  Content(const Content&) = delete;
  Content& operator=(const Content&) = delete;

  template <class Read>
  auto visit(Read&& read) const {
    return read(encoded_);
  }

 private:
  std::string bytes_;
  Encoded encoded_;
};

void check_suffix(const std::filesystem::path& path) {
  if (is_picture_suffix(path)) return;
  std::string known;
  for (const char* suffix : kSuffixes) known += std::string(known.empty() ? "" : " ") + suffix;
  throw files::FileError(files::Cause::device, path.string(), "",
                         "cannot write: the suffix of a picture is one of " + known);
}

Rgba8 straight(const Rgba8& c) {
  if (c.a == 255) return c;
  if (c.a == 0) return {};
  const float alpha = decode_alpha(c.a);
  const auto code = [alpha](std::uint8_t v) { return encode_srgb(decode_srgb(v) / alpha); };
  return {code(c.r), code(c.g), code(c.b), c.a};
}

std::vector<Rgba8> straight(const Image8& image) {
  std::vector<Rgba8> codes(image.pixels());
  std::transform(image.colour.data(), image.colour.data() + image.pixels(), codes.begin(),
                 [](const Rgba8& c) { return straight(c); });
  return codes;
}

void write_bytes(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  files::write_file(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace

std::vector<std::byte> encode_png(const Image8& image, std::span<const Attribute> attributes) {
  return encode_png(image.width, image.height, straight(image), attributes);
}

struct PictureRows::File {
  files::AtomicFile target;
  bool is_exr;
  int width, missing;
  std::unique_ptr<openimageio::RowSink> rows;

  void append(const void* values, int count) {
    assert(count <= missing);
    missing -= count;
    rows->append(values, count);
  }
};

bool is_written_in_rows(const std::filesystem::path& path) {
  const std::string suffix = picture_suffix(path);
  return path != "-" && (suffix == ".exr" || suffix == ".tif" || suffix == ".tiff");
}

PictureRows::PictureRows(const std::filesystem::path& path, int width, int height,
                         const WriteOptions& options) {
  assert(is_written_in_rows(path) && width >= 1 && height >= 1 && options.channels.empty());
  const bool is_exr = picture_suffix(path) == ".exr";
  file_.reset(new File{files::AtomicFile(path), is_exr, width, height, nullptr});
  file_->rows =
      codec().open_rows({file_->target.temporary(), path.string()}, width, height, is_exr, options);
}
PictureRows::~PictureRows() = default;

void PictureRows::append(const Image8& rows) {
  assert(rows.width == file_->width);
  if (file_->is_exr) return append(to_float(rows));
  file_->append(straight(rows).data(), rows.height);
}

void PictureRows::append(const ImageF& rows) {
  assert(rows.width == file_->width);
  if (!file_->is_exr) return append(to_8bit(rows));
  struct Values {
    RgbaF colour;
    float depth;
  };
  std::vector<Values> values(rows.pixels());
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = {rows.colour[i], rows.depth[i]};
  file_->append(values.data(), rows.height);
}

void PictureRows::commit() {
  assert(file_->missing == 0);
  file_->rows->close();
  file_->target.commit();
}

PictureInfo read_info(const std::filesystem::path& path, const files::MemoryBudget& memory) {
  // Only looks at a stream, which somebody may want to read afterwards.
  return Content(path, memory, Content::Stream::stays).visit(codec().read_info);
}

Picture read_picture(const std::filesystem::path& path, const files::MemoryBudget& memory) {
  return Content(path, memory).visit([](const Encoded& from) {
    return codec().read_picture(from, true);
  });
}

ImageF read_image_float(const std::filesystem::path& path, const files::MemoryBudget& memory) {
  return Content(path, memory).visit([](const Encoded& from) {
    return codec().read_picture(from, false).image;
  });
}

Image8 read_image8(const std::filesystem::path& path) { return to_8bit(read_image_float(path)); }

Texels read_texels(const std::filesystem::path& path, const files::MemoryBudget& memory) {
  return Content(path, memory).visit(codec().read_texels);
}

Texels decode_image8(std::span<const std::byte> bytes, const std::string& name,
                     const files::MemoryBudget& memory) {
  return codec().read_texels({name, bytes, memory});
}

RawChannels read_float_channels(const std::filesystem::path& path,
                                const files::MemoryBudget& memory) {
  return Content(path, memory).visit(codec().read_float_channels);
}

std::span<const char* const> picture_suffixes() { return kSuffixes; }

std::string picture_suffix(const std::filesystem::path& path) {
  if (path == "-") return ".png";
  std::string suffix = path.extension().string();
  for (char& c : suffix) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return suffix;
}

bool is_picture_suffix(const std::filesystem::path& path) {
  const std::string suffix = picture_suffix(path);
  return std::find(kSuffixes.begin(), kSuffixes.end(), suffix) != kSuffixes.end();
}

void write_image(const std::filesystem::path& path, const Image8& image,
                 const WriteOptions& options) {
  assert(image.width >= 1 && image.height >= 1);
  check_suffix(path);
  const std::string suffix = picture_suffix(path);
  if (suffix == ".exr") return write_image(path, to_float(image), options);
  if (suffix == ".png") {
    return write_bytes(path, encode_png(image, options.attributes));
  }
  if (suffix == ".jpg" || suffix == ".jpeg") {
    return write_bytes(path, codec().encode_jpeg(path.string(), image, options));
  }
  files::AtomicFile target(path);
  codec().write_tiff({target.temporary(), path.string()}, image.width, image.height,
                     straight(image), options);
  target.commit();
}

void write_image(const std::filesystem::path& path, const ImageF& image,
                 const WriteOptions& options) {
  assert(image.width >= 1 && image.height >= 1);
  check_suffix(path);
  if (picture_suffix(path) != ".exr") return write_image(path, to_8bit(image), options);
  for ([[maybe_unused]] const Channel& channel : options.channels) {
    assert(channel.values.size() == image.pixels());
  }
  files::AtomicFile target(path);
  codec().write_exr({target.temporary(), path.string()}, image, options);
  target.commit();
}

}  // namespace delray::image
