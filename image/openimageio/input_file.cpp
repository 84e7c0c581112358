#include <algorithm>
#include <cctype>
#include <cstdint>
#include <string_view>

#include "files/error.h"
#include "files/read_file.h"
#include "image/io.h"
#include "image/openimageio/input_file.h"

#if defined(__SANITIZE_ADDRESS__)
#define DELRAY_LEAK_CHECKER 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define DELRAY_LEAK_CHECKER 1
#endif
#endif
#ifdef DELRAY_LEAK_CHECKER
#include <sanitizer/lsan_interface.h>
#endif

namespace delray::image::openimageio {
namespace {

constexpr std::size_t kMagicBytes = 16;
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
#ifdef DELRAY_LEAK_CHECKER
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

InputFile::InputFile(const std::filesystem::path& path) : name_(path.string()) {
  format_ = format_of_content(files::read_start(path, kMagicBytes));
  if (format_.empty()) format_ = format_of_suffix(path);
  open(path.string(), reading_hints());
}

InputFile::InputFile(std::span<const std::byte> bytes, std::string name) : name_(std::move(name)) {
  format_ = format_of_content(
      {reinterpret_cast<const char*>(bytes.data()), std::min(bytes.size(), kMagicBytes)});
  memory_ = std::make_unique<OIIO::Filesystem::IOMemReader>(const_cast<std::byte*>(bytes.data()),
                                                            bytes.size());
  open(format_, reading_hints());
}

void InputFile::fail(const std::string& what) const {
  throw files::FileError(files::Cause::input, name_, "", what);
}

void InputFile::open(const std::string& name, const OIIO::ImageSpec& hints) {
  if (!format_.empty()) input_ = OIIO::ImageInput::create(format_);
  if (!input_) {
    OIIO::geterror();  // which names the suffix only
    fail("is not a picture in a format that is known");
  }
  if (memory_ && !(input_->supports("ioproxy") && input_->set_ioproxy(memory_.get()))) {
    fail("pictures of the format " + format_ + " cannot be embedded in other files");
  }
  bool opened = false;
  try {
    const ForgiveLeaks here;
    opened = input_->open(name, spec_, hints);
  } catch (const std::exception& error) {
    fail(std::string("is a damaged picture: ") + error.what());
  }
  if (!opened) {
    const std::string what = input_->geterror();
    fail("is a damaged picture" + (what.empty() ? "" : ": " + what));
  }
  check_header();
}

void InputFile::check_header() const {
  if (spec_.deep) fail("deep pictures cannot be read");
  if (spec_.depth > 1) fail("volumes cannot be read");
  if (spec_.width <= 0 || spec_.height <= 0 || spec_.nchannels <= 0) fail("has no pixels");
  const auto too_large = [](const OIIO::ImageSpec& spec, int width, int height) {
    const auto pixels = static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
    return width < 0 || height < 0 || pixels > kMaximumPixels ||
           pixels > kMaximumBytes / std::max<std::uint64_t>(1, spec.pixel_bytes(true));
  };
  if (too_large(spec_, spec_.width, spec_.height) ||
      too_large(spec_, spec_.full_width, spec_.full_height)) {
    fail("claims " + std::to_string(spec_.width) + " x " + std::to_string(spec_.height) +
         " pixels, more than can be read");
  }
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
    const std::string what = input_->geterror();
    fail("is a damaged picture" + (what.empty() ? "" : ": " + what));
  }
}

}  // namespace delray::image::openimageio
