// The part of reading and writing that needs OpenImageIO. It is a library of its own,
// delray_openimageio, that io.cpp loads on first use: OpenImageIO brings 250 others, which take a
// program a sixth of a second to start.
#pragma once

#include <memory>
#include <optional>

#include "image/io.h"

namespace delray::image::openimageio {

inline constexpr const char* kLibrary = "libdelray_openimageio.so";
inline constexpr const char* kEntry = "delray_openimageio_codec";

// A picture in the file `name`, or in these bytes.
struct Encoded {
  std::string name;  // for errors too
  std::optional<std::span<const std::byte>> bytes;
  files::MemoryBudget memory;  // for what is made of it
};

// Where to write, and whom to name in errors.
struct Target {
  std::filesystem::path file;
  std::string name;
};

// A tiled file that is written from top to bottom.
class RowSink {
 public:
  virtual ~RowSink() = default;
  // `count` rows of interleaved values: of an EXR floats R, G, B, A, Z, of a TIFF bytes R, G, B, A.
  virtual void append(const void* values, int count) = 0;
  // After the last row.
  virtual void close() = 0;
};

// As the functions of io.h by these names, but that files are written in place.
struct Codec {
  PictureInfo (*read_info)(const Encoded& from);
  Picture (*read_picture)(const Encoded& from, bool with_channels);
  Texels (*read_texels)(const Encoded& from);
  RawChannels (*read_float_channels)(const Encoded& from);
  void (*write_exr)(const Target& target, const ImageF& image, const WriteOptions& options);
  // Straight alpha.
  void (*write_tiff)(const Target& target, int width, int height, std::span<const Rgba8> texels,
                     const WriteOptions& options);
  std::vector<std::byte> (*encode_jpeg)(const std::string& name, const Image8& image,
                                        const WriteOptions& options);
  // Straight alpha.
  std::unique_ptr<RowSink> (*open_rows)(const Target& target, int width, int height, bool is_exr,
                                        const WriteOptions& options);
};

// The entries of a Codec, in read.cpp and write.cpp.
PictureInfo read_info(const Encoded& from);
Picture read_picture(const Encoded& from, bool with_channels);
Texels read_texels(const Encoded& from);
RawChannels read_float_channels(const Encoded& from);
void write_exr(const Target& target, const ImageF& image, const WriteOptions& options);
void write_tiff(const Target& target, int width, int height, std::span<const Rgba8> texels,
                const WriteOptions& options);
std::vector<std::byte> encode_jpeg(const std::string& name, const Image8& image,
                                   const WriteOptions& options);
std::unique_ptr<RowSink> open_rows(const Target& target, int width, int height, bool is_exr,
                                   const WriteOptions& options);

}  // namespace delray::image::openimageio
