// Pictures in files and in memory, through OpenImageIO.
//
// The format of a file follows from its content, then its suffix; streams are read as well as
// files. Everything that reads throws files::FileError (input) for a file that is missing, damaged,
// cut short or larger than kMaximumPixels or kMaximumBytes, and FileError (memory) for one that
// unpacks to more than `memory`: its header is checked before anything is allocated. Everything
// that writes throws FileError (device) and leaves the file whole or as it was. Files are the same
// bytes for the same call.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "files/memory_budget.h"
#include "image/image.h"

namespace delray::image {

inline constexpr std::uint64_t kMaximumPixels = std::uint64_t{1} << 29;
inline constexpr std::uint64_t kMaximumBytes = std::uint64_t{1} << 32;  // uncompressed, in the file

// A further channel of a picture, such as "albedo.R": one value per pixel, top row first.
struct Channel {
  std::string name;
  std::vector<float> values;
};

// A fact about a picture. Only EXR keeps all of them; PNG keeps the strings.
struct Attribute {
  std::string name;
  std::variant<std::string, double> value;
  bool operator==(const Attribute&) const = default;
};

// A picture with all that its file says.
struct Picture {
  ImageF image;
  std::vector<Channel> channels;
  std::vector<Attribute> attributes;
};

// The contents of a picture file's header.
struct PictureInfo {
  int width = 0, height = 0;
  std::string format;                 // "png", "openexr", ...
  std::string type;                   // of a value: "uint8", "half", "float", ...
  std::vector<std::string> channels;  // names in file order
  std::vector<Attribute> attributes;
};
PictureInfo read_info(const std::filesystem::path& path, const files::MemoryBudget& memory = {});

// Colour from channels R, G, B, or one channel as grey; premultiplied and decoded as image.h says:
// integer files are sRGB, float files linear. Without alpha a picture is opaque. Depth from Z;
// without it 0 where alpha is positive, kEmptyDepth elsewhere. An EXR data window is placed in its
// display window.
Picture read_picture(const std::filesystem::path& path, const files::MemoryBudget& memory = {});
ImageF read_image_float(const std::filesystem::path& path, const files::MemoryBudget& memory = {});
// As to_8bit(read_image_float(path)); a PNG that write_image wrote comes back with the same bytes
// where alpha is 0 or 255.
Image8 read_image8(const std::filesystem::path& path);

// Colours as textures hold them: codes as in the file (floats are coded to sRGB), alpha straight,
// top row first. `name` stands for the file in errors.
struct Texels {
  int width = 0, height = 0;
  std::vector<Rgba8> texels;
};
Texels read_texels(const std::filesystem::path& path, const files::MemoryBudget& memory = {});
// From the bytes of a file (PNG, JPEG, EXR ...).
Texels decode_image8(std::span<const std::byte> bytes, const std::string& name,
                     const files::MemoryBudget& memory = {});

// The numbers of a file as they are: 0 to 255 for 8 bits, 0 to 65535 for 16 bits, floats unchanged;
// for elevations and other measurements. Value of channel c at (x, y) is
// values[(y * width + x) * channels.size() + c].
struct RawChannels {
  int width = 0, height = 0;
  std::vector<std::string> channels;
  std::vector<double> values;
};
RawChannels read_float_channels(const std::filesystem::path& path,
                                const files::MemoryBudget& memory = {});

// Channels that a picture file gets besides colours, and how exact it is.
struct WriteOptions {
  bool half = false;                  // EXR: 16-bit colour; depth and channels stay 32-bit
  std::span<const Channel> channels;  // EXR only
  std::span<const Attribute> attributes;
  int jpeg_quality = 95;
};

// Suffixes that write_image knows, lower case, with the dot.
std::span<const char* const> picture_suffixes();
bool is_picture_suffix(const std::filesystem::path& path);  // of the path; in any case
// That of the path, lower case; ".png" for "-".
std::string picture_suffix(const std::filesystem::path& path);

// EXR holds linear premultiplied colour, depth and channels. PNG and TIFF hold 8-bit sRGB with
// straight alpha (colour is lost where alpha is 0), JPEG the picture over black. A suffix that is
// not known is an error that lists those that are. "-" is a PNG on standard output.
//
// REQUIRES: width, height >= 1; each channel has as many values as there are pixels.
void write_image(const std::filesystem::path& path, const Image8& image,
                 const WriteOptions& options = {});
void write_image(const std::filesystem::path& path, const ImageF& image,
                 const WriteOptions& options = {});

// Texels as a PNG in memory, unchanged, with those of the attributes that are text.
// REQUIRES: texels.size() == width * height, both >= 1.
std::vector<std::byte> encode_png(int width, int height, std::span<const Rgba8> texels,
                                  std::span<const Attribute> attributes = {});
// The PNG that write_image would write, in memory.
std::vector<std::byte> encode_png(const Image8& image, std::span<const Attribute> attributes = {});

}  // namespace delray::image
