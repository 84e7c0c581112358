// What of reading and writing needs OpenImageIO. It is a library of its own, delray_openimageio,
// that io.cpp loads on first use: OpenImageIO brings 250 others, which take a program a sixth of a
// second to start.
#pragma once

#include "image/io.h"

namespace delray::image::openimageio {

inline constexpr const char* kLibrary = "libdelray_openimageio.so";
inline constexpr const char* kEntry = "delray_openimageio_codec";

// Where to write, and whom to name in errors.
struct Target {
  std::filesystem::path file;
  std::string name;
};

// As the functions of io.h by these names, but that files are written in place.
struct Codec {
  PictureInfo (*read_info)(const std::filesystem::path& path);
  Picture (*read_picture)(const std::filesystem::path& path, bool with_channels);
  Texels (*read_texels)(const std::filesystem::path& path);
  Texels (*decode_image8)(std::span<const std::byte> bytes, const std::string& name);
  RawChannels (*read_float_channels)(const std::filesystem::path& path);
  void (*write_exr)(const Target& target, const ImageF& image, const WriteOptions& options);
  // Straight alpha.
  void (*write_tiff)(const Target& target, int width, int height, std::span<const Rgba8> texels,
                     const WriteOptions& options);
  std::vector<std::byte> (*encode_jpeg)(const std::string& name, const Image8& image,
                                        const WriteOptions& options);
};

// The entries of a Codec, in read.cpp and write.cpp.
PictureInfo read_info(const std::filesystem::path& path);
Picture read_picture(const std::filesystem::path& path, bool with_channels);
Texels read_texels(const std::filesystem::path& path);
Texels decode_image8(std::span<const std::byte> bytes, const std::string& name);
RawChannels read_float_channels(const std::filesystem::path& path);
void write_exr(const Target& target, const ImageF& image, const WriteOptions& options);
void write_tiff(const Target& target, int width, int height, std::span<const Rgba8> texels,
                const WriteOptions& options);
std::vector<std::byte> encode_jpeg(const std::string& name, const Image8& image,
                                   const WriteOptions& options);

}  // namespace delray::image::openimageio
