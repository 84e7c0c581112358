// JPEG is written by libjpeg-turbo itself: through OpenImageIO the pixels would be converted first.
#include "image/jpeg.h"

#include <cstdio>
// After <cstdio>, which it does not include.
#include <jpeglib.h>

#include <algorithm>
#include <cassert>
#include <csetjmp>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>

#include "files/error.h"

namespace delray::image {
namespace {

// From this quality on colours have the resolution of brightness.
constexpr int kWholeColours = 90;

// libjpeg is written in C and ends the program on errors unless it is kept from it.
struct JpegWriter {
  jpeg_compress_struct compress{};
  jpeg_error_mgr errors{};
  std::jmp_buf failed{};
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  std::string error;

  JpegWriter() = default;
  JpegWriter(const JpegWriter&) = delete;
  JpegWriter& operator=(const JpegWriter&) = delete;
  ~JpegWriter() {
    jpeg_destroy_compress(&compress);
    std::free(bytes);
  }
};

[[noreturn]] void note_jpeg_error(j_common_ptr compress) {
  auto* writer = static_cast<JpegWriter*>(compress->client_data);
  char text[JMSG_LENGTH_MAX] = "";
  (*compress->err->format_message)(compress, text);
  try {
    writer->error = text;
  } catch (const std::bad_alloc&) {  // the error has no text then
  }
  std::longjmp(writer->failed, 1);
}

// Has nothing to destroy, as an error jumps out of it.
[[gnu::noinline]] void write_jpeg(JpegWriter& writer, const Image8& image, int quality) {
  jpeg_compress_struct& compress = writer.compress;
  jpeg_create_compress(&compress);
  jpeg_mem_dest(&compress, &writer.bytes, &writer.size);
  compress.image_width = static_cast<JDIMENSION>(image.width);
  compress.image_height = static_cast<JDIMENSION>(image.height);
  compress.input_components = 4;
  compress.in_color_space = JCS_EXT_RGBX;
  jpeg_set_defaults(&compress);
  jpeg_set_quality(&compress, quality, TRUE);
  compress.dct_method = JDCT_IFAST;
  if (quality >= kWholeColours) {
    compress.comp_info[0].h_samp_factor = 1;
    compress.comp_info[0].v_samp_factor = 1;
    compress.dct_method = JDCT_ISLOW;
  }
  jpeg_start_compress(&compress, TRUE);
  static_assert(sizeof(Rgba8) == 4);
  while (compress.next_scanline < compress.image_height) {
    const Rgba8* const row =
        image.colour.data() +
        static_cast<std::size_t>(compress.next_scanline) * static_cast<std::size_t>(image.width);
    auto* pixels = reinterpret_cast<JSAMPROW>(const_cast<Rgba8*>(row));
    jpeg_write_scanlines(&compress, &pixels, 1);
  }
  jpeg_finish_compress(&compress);
}

// False after an error.
[[gnu::noinline]] bool try_write_jpeg(JpegWriter& writer, const Image8& image, int quality) {
  if (setjmp(writer.failed) != 0) return false;
  write_jpeg(writer, image, quality);
  return true;
}

}  // namespace

std::vector<std::byte> encode_jpeg(const Image8& image, int quality) {
  assert(image.width >= 1 && image.height >= 1);
  JpegWriter writer;
  writer.compress.err = jpeg_std_error(&writer.errors);
  writer.errors.error_exit = note_jpeg_error;
  writer.compress.client_data = &writer;
  if (!try_write_jpeg(writer, image, std::clamp(quality, 1, 100)))
    throw files::FileError(files::Cause::device, "jpeg", "", writer.error);
  std::vector<std::byte> bytes(writer.size);
  std::memcpy(bytes.data(), writer.bytes, writer.size);
  return bytes;
}

}  // namespace delray::image
