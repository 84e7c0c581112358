// PNG is written by libpng itself, so that who writes nothing else need not load OpenImageIO.
#include <png.h>

#include <algorithm>
#include <cassert>
#include <csetjmp>
#include <new>
#include <string>
#include <utility>

#include "files/error.h"
#include "image/io.h"

namespace delray::image {
namespace {

// Level 6 (zlib's default) takes half as long again for pictures 6 % smaller.
constexpr int kCompressionLevel = 4;

struct Writer {
  std::vector<std::byte> bytes;
  std::string error;
  bool out_of_memory = false;
};

// libpng is written in C: nothing may be thrown through it.
void append(png_structp png, png_bytep data, std::size_t size) {
  auto* writer = static_cast<Writer*>(png_get_io_ptr(png));
  try {
    const auto* from = reinterpret_cast<const std::byte*>(data);
    writer->bytes.insert(writer->bytes.end(), from, from + size);
  } catch (const std::bad_alloc&) {
    writer->out_of_memory = true;
  }
  if (writer->out_of_memory) png_error(png, "out of memory");
}

void note_error(png_structp png, png_const_charp what) {
  auto* writer = static_cast<Writer*>(png_get_error_ptr(png));
  try {
    writer->error = what;
  } catch (const std::bad_alloc&) {
    writer->out_of_memory = true;
  }
  png_longjmp(png, 1);
}

void ignore_warning(png_structp, png_const_charp) {}

// Has nothing to destroy, as an error jumps out of it.
[[gnu::noinline]] void write(png_structp png, png_infop info, int width, int height,
                             const Rgba8* texels, const std::vector<png_text>& texts) {
  png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
  png_set_compression_level(png, kCompressionLevel);
  png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_NO_FILTERS);
  png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), 8,
               PNG_COLOR_TYPE_RGB_ALPHA, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  if (!texts.empty()) png_set_text(png, info, texts.data(), static_cast<int>(texts.size()));
  png_write_info(png, info);
  for (int y = 0; y < height; ++y, texels += width) {
    png_write_row(png, reinterpret_cast<png_const_bytep>(texels));
  }
  png_write_end(png, info);
}

// False after an error.
[[gnu::noinline]] bool try_write(png_structp png, png_infop info, int width, int height,
                                 const Rgba8* texels, const std::vector<png_text>& texts) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  write(png, info, width, height, texels, texts);
  return true;
}

// Numbers have no place in a PNG.
std::vector<png_text> texts_of(std::span<const Attribute> attributes) {
  std::vector<png_text> texts;
  for (const Attribute& attribute : attributes) {
    const auto* value = std::get_if<std::string>(&attribute.value);
    if (value == nullptr) continue;
    png_text text{};
    const bool ascii = std::ranges::all_of(*value, [](unsigned char c) { return c < 0x80; });
    text.compression = ascii ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE;
    text.key = const_cast<png_charp>(attribute.name.c_str());
    text.text = const_cast<png_charp>(value->c_str());
    texts.push_back(text);
  }
  return texts;
}

}  // namespace

std::vector<std::byte> encode_png(int width, int height, std::span<const Rgba8> texels,
                                  std::span<const Attribute> attributes) {
  static_assert(sizeof(Rgba8) == 4);
  assert(width >= 1 && height >= 1);
  assert(texels.size() == static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  Writer writer;
  const std::vector<png_text> texts = texts_of(attributes);
  png_structp png =
      png_create_write_struct(PNG_LIBPNG_VER_STRING, &writer, note_error, ignore_warning);
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
  writer.out_of_memory = info == nullptr;
  bool written = false;
  if (info != nullptr) {
    png_set_write_fn(png, &writer, append, nullptr);
    written = try_write(png, info, width, height, texels.data(), texts);
  }
  png_destroy_write_struct(&png, &info);
  if (writer.out_of_memory) throw std::bad_alloc();
  if (!written) throw files::FileError(files::Cause::device, "png", "", writer.error);
  return std::move(writer.bytes);
}

}  // namespace delray::image
