// Opens a picture by its magic bytes or suffix and checks what its header claims before anything is
// allocated. Sizes of formats that OpenImageIO unpacks on opening are read from the raw bytes
// before. Exceptions and messages of OpenImageIO become FileError.
#include <algorithm>
#include <cctype>
#include <cstdint>
#include <filesystem>
#include <string_view>

#include "files/error.h"
#include "files/read_file.h"
#include "image/io.h"
#include "image/openimageio/input_file.h"

#ifdef DELRAY_ASAN
#include <sanitizer/lsan_interface.h>
#endif

namespace delray::image::openimageio {
namespace {

constexpr std::size_t kStartBytes = 256;  // the marks of formats, and sizes that are looked for
constexpr int kRows = 64;  // of a block; a multiple of the rows that EXR compresses together

// OpenImageIO's name of the format that starts with `start`; empty when none is recognised. Its own
// way, to let every reader try, hands garbage to dozens of parsers.
std::string format_of_content(std::string_view start) {
  struct Magic {
    std::string_view bytes;
    const char* format;
  };
  using namespace std::string_view_literals;
  constexpr Magic kMagics[] = {
      {"\x89PNG\r\n\x1a\n"sv, "png"},
      {"\xff\xd8\xff"sv, "jpeg"},
      {"II*\0"sv, "tiff"},
      {"MM\0*"sv, "tiff"},
      {"II+\0"sv, "tiff"},
      {"MM\0+"sv, "tiff"},
      {"\x76\x2f\x31\x01"sv, "openexr"},
      {"#?RADIANCE"sv, "hdr"},
      {"#?RGBE"sv, "hdr"},
      {"BM"sv, "bmp"},
      {"GIF8"sv, "gif"},
      {"DDS "sv, "dds"},
      {"P1"sv, "pnm"},
      {"P2"sv, "pnm"},
      {"P3"sv, "pnm"},
      {"P4"sv, "pnm"},
      {"P5"sv, "pnm"},
      {"P6"sv, "pnm"},
      {"PF"sv, "pnm"},
      {"Pf"sv, "pnm"},
      {"SIMPLE  ="sv, "fits"},
      {"\0\0\0\x0cjP  \r\n\x87\n"sv, "jpeg2000"},
  };
  for (const Magic& magic : kMagics) {
    if (start.starts_with(magic.bytes)) return magic.format;
  }
  if (start.starts_with("RIFF") && start.substr(8).starts_with("WEBP")) return "webp";
  return {};
}

// For formats whose files have no mark of their own, such as Targa.
std::string format_of_suffix(const std::filesystem::path& path) {
  std::string suffix = path.extension().string();
  if (!suffix.empty()) suffix.erase(0, 1);
  for (char& c : suffix) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return suffix;
}

// OpenImageIO 2.4's PNG reader leaks a message where a file ends early (libpng jumps over the
// string's destructor); that must not turn a refused file into a failed check for leaks.
#ifdef DELRAY_ASAN
using ForgiveLeaks = __lsan::ScopedDisabler;
#else
struct ForgiveLeaks {
  ForgiveLeaks() {}
};
#endif

OIIO::ImageSpec reading_hints() {
  OIIO::ImageSpec hints;
  hints.attribute("oiio:UnassociatedAlpha", 1);
  return hints;
}

}  // namespace

InputFile::InputFile(const Encoded& from) : name_(from.name), budget_(from.memory) {
  std::string start;
  if (from.bytes) {
    start.assign(reinterpret_cast<const char*>(from.bytes->data()),
                 std::min(from.bytes->size(), kStartBytes));
    bytes_ = std::make_unique<OIIO::Filesystem::IOMemReader>(
        const_cast<std::byte*>(from.bytes->data()), from.bytes->size());
  } else {
    start = files::read_start(name_, kStartBytes);
  }
  format_ = format_of_content(start);
  if (format_.empty() && !bytes_) format_ = format_of_suffix(name_);
  check_canvas(start);
  check_png(png_header_fault);
  open(bytes_ ? format_ : name_, reading_hints());
}

void InputFile::fail(const std::string& what) const {
  throw files::FileError(files::Cause::input, name_, "", what);
}

// The first of the messages that pile up in a reader says what happened, the others repeat it.
void InputFile::fail_as_damaged() const {
  const std::string all = input_->geterror();
  const std::string first = all.substr(0, all.find('\n'));
  fail("is a damaged picture" + (first.empty() ? "" : ": " + first));
}

void InputFile::check_png(std::string (*fault)(OIIO::Filesystem::IOProxy&)) const {
  if (format_ != "png") return;
  std::string what;
  if (bytes_) {
    what = fault(*bytes_);
  } else {
    OIIO::Filesystem::IOFile file(name_, OIIO::Filesystem::IOProxy::Read);
    what = fault(file);
  }
  if (!what.empty()) fail("is a damaged picture: " + what);
}

void InputFile::open(const std::string& name, const OIIO::ImageSpec& hints) {
  if (!format_.empty()) input_ = OIIO::ImageInput::create(format_);
  if (!input_) {
    OIIO::geterror();  // which names the suffix only
    fail("is not a picture in a format that is known");
  }
  if (bytes_ && !(input_->supports("ioproxy") && input_->set_ioproxy(bytes_.get()))) {
    fail("pictures of the format " + format_ + " are read from files only");
  }
  bool opened = false;
  try {
    const ForgiveLeaks here;
    opened = input_->open(name, spec_, hints);
  } catch (const std::exception& error) {
    fail(std::string("is a damaged picture: ") + error.what());
  }
  if (!opened) {
    fail_as_damaged();
  }
  check_header();
}

void InputFile::check_header() const {
  if (spec_.deep) fail("deep pictures cannot be read");
  if (spec_.depth > 1) fail("volumes cannot be read");
  if (spec_.width <= 0 || spec_.height <= 0 || spec_.nchannels <= 0) fail("has no pixels");
  if (spec_.full_width < 0 || spec_.full_height < 0) fail("has a negative size");
  const auto size = [](int side) { return static_cast<std::uint64_t>(side); };
  const auto bytes = std::max<std::uint64_t>(1, spec_.pixel_bytes(true));
  check_size(size(spec_.width), size(spec_.height), bytes);
  check_size(size(spec_.full_width), size(spec_.full_height), bytes);
}

void InputFile::check_size(std::uint64_t width, std::uint64_t height,
                           std::uint64_t pixel_bytes) const {
  const std::uint64_t pixels = width * height;  // both are below 2^32
  if (pixels > kMaximumPixels || pixels > kMaximumBytes / pixel_bytes) {
    fail("claims " + std::to_string(width) + " x " + std::to_string(height) +
         " pixels, more than can be read");
  }
}

// Formats that OpenImageIO unpacks while it opens the file, before anybody can ask for the size.
void InputFile::check_canvas(std::string_view start) const {
  const auto byte = [&](std::size_t at) {
    return at < start.size() ? static_cast<std::uint8_t>(start[at]) : std::uint64_t{0};
  };
  const auto require = [&](std::uint64_t width, std::uint64_t height, std::uint64_t pixel_bytes) {
    check_size(width, height, pixel_bytes);
    budget_.require(width * height * pixel_bytes, name_);
  };
  if (format_ == "gif") {
    require(byte(7) << 8 | byte(6), byte(9) << 8 | byte(8), 4);
  } else if (format_ == "jpeg2000") {
    const std::size_t header = start.find("ihdr");  // height, width, channels
    if (header == std::string_view::npos) fail("is a damaged picture: it has no size");
    const auto number = [&](std::size_t at) {
      return byte(at) << 24 | byte(at + 1) << 16 | byte(at + 2) << 8 | byte(at + 3);
    };
    const std::uint64_t channels = byte(header + 12) << 8 | byte(header + 13);
    require(number(header + 8), number(header + 4),
            std::max<std::uint64_t>(1, channels) * sizeof(std::int32_t));
  }
}

void InputFile::require_memory(std::uint64_t pixels, std::size_t bytes) const {
  // Readers of many formats, and of interlaced PNG, unpack the whole file.
  const std::uint64_t unpacked = spec_.image_bytes(true);
  const std::uint64_t block = static_cast<std::uint64_t>(std::min(rows_per_block(), spec_.height)) *
                              static_cast<std::uint64_t>(spec_.width) *
                              static_cast<std::uint64_t>(spec_.nchannels) * sizeof(double);
  budget_.require(pixels * bytes + unpacked + block, name_);
}

int InputFile::rows_per_block() const {
  if (spec_.tile_width == 0) return kRows;
  return std::max(1, spec_.tile_height) * std::max(1, kRows / std::max(1, spec_.tile_height));
}

void InputFile::read_rows(int y, int rows, OIIO::TypeDesc type, void* values) {
  const int y0 = spec_.y + y;
  bool done = false;
  try {
    const ForgiveLeaks here;
    done = spec_.tile_width == 0
               ? input_->read_scanlines(0, 0, y0, y0 + rows, 0, 0, spec_.nchannels, type, values)
               : input_->read_tiles(0, 0, spec_.x, spec_.x + spec_.width, y0, y0 + rows, 0, 1, 0,
                                    spec_.nchannels, type, values);
  } catch (const std::exception& error) {
    fail(std::string("is a damaged picture: ") + error.what());
  }
  // Some readers fill up what is missing, report success, and leave a message.
  if (!done || input_->has_error()) {
    fail_as_damaged();
  }
}

}  // namespace delray::image::openimageio
