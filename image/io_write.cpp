#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cctype>
#include <iterator>

#include "files/atomic_file.h"
#include "files/error.h"
#include "image/io.h"
#include "image/srgb.h"

namespace delray::image {
namespace {

constexpr std::array kSuffixes = {".exr", ".png", ".tif", ".tiff", ".jpg", ".jpeg"};

std::string lower_suffix(const std::filesystem::path& path) {
  std::string suffix = path.extension().string();
  for (char& c : suffix) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return suffix;
}

// What OpenImageIO says, with the name that the user knows in place of the temporary one.
[[noreturn]] void fail(const std::filesystem::path& path, const std::string& temporary,
                       std::string what) {
  for (std::size_t at; !temporary.empty() && (at = what.find(temporary)) != std::string::npos;) {
    what.replace(at, temporary.size(), path.string());
  }
  throw files::FileError(files::Cause::device, path.string(), "", "cannot write: " + what);
}

void add_attributes(OIIO::ImageSpec& spec, std::span<const Attribute> attributes) {
  spec.attribute("DateTime", "");  // or the time of writing would go into the file
  for (const Attribute& attribute : attributes) {
    if (const auto* text = std::get_if<std::string>(&attribute.value)) {
      spec.attribute(attribute.name, *text);
    } else {
      const double number = std::get<double>(attribute.value);
      spec.attribute(attribute.name, OIIO::TypeDesc::DOUBLE, &number);
    }
  }
}

// Writes rows of interleaved values, all in one call; whole or not at all.
void write_values(const std::filesystem::path& path, const OIIO::ImageSpec& spec,
                  OIIO::TypeDesc type, const void* values) {
  files::AtomicFile target(path);
  const std::string temporary = target.temporary().string();
  const auto output = OIIO::ImageOutput::create(temporary);
  if (!output) fail(path, temporary, OIIO::geterror());
  try {
    const bool written = output->open(temporary, spec) && output->write_image(type, values);
    // Also after a failure, so that the file is closed before it is removed.
    const bool closed = output->close();
    if (!written || !closed || output->has_error()) fail(path, temporary, output->geterror());
  } catch (const files::FileError&) {
    throw;
  } catch (const std::exception& error) {
    fail(path, temporary, error.what());
  }
  target.commit();
}

void write_exr(const std::filesystem::path& path, const ImageF& image,
               const WriteOptions& options) {
  const std::size_t channels = 5 + options.channels.size();
  OIIO::ImageSpec spec(image.width, image.height, static_cast<int>(channels),
                       OIIO::TypeDesc::FLOAT);
  spec.channelnames = {"R", "G", "B", "A", "Z"};
  spec.alpha_channel = 3;
  spec.z_channel = 4;
  for (const Channel& channel : options.channels) {
    assert(channel.values.size() == image.pixels());
    spec.channelnames.push_back(channel.name);
  }
  if (options.half) {
    spec.channelformats.assign(channels, OIIO::TypeDesc::FLOAT);
    std::fill_n(spec.channelformats.begin(), 4, OIIO::TypeDesc::HALF);
  }
  add_attributes(spec, options.attributes);
  std::vector<float> values(image.pixels() * channels);
  for (std::size_t i = 0; i < image.pixels(); ++i) {
    float* pixel = values.data() + i * channels;
    const RgbaF& c = image.colour[i];
    const float own[] = {c.r, c.g, c.b, c.a, image.depth[i]};
    pixel = std::copy(std::begin(own), std::end(own), pixel);
    for (const Channel& channel : options.channels) *pixel++ = channel.values[i];
  }
  write_values(path, spec, OIIO::TypeDesc::FLOAT, values.data());
}

Rgba8 straight(const Rgba8& c) {
  if (c.a == 255) return c;
  if (c.a == 0) return {};
  const float alpha = decode_alpha(c.a);
  const auto code = [alpha](std::uint8_t v) { return encode_srgb(decode_srgb(v) / alpha); };
  return {code(c.r), code(c.g), code(c.b), c.a};
}

OIIO::ImageSpec spec_of_codes(int width, int height, int channels) {
  OIIO::ImageSpec spec(width, height, channels, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  if (channels == 4) spec.attribute("oiio:UnassociatedAlpha", 1);
  // Of pictures, 6 (the default) takes half as long again for files 6 % smaller.
  spec.attribute("png:compressionLevel", 4);
  return spec;
}

void write_codes(const std::filesystem::path& path, const Image8& image,
                 const WriteOptions& options) {
  OIIO::ImageSpec spec = spec_of_codes(image.width, image.height, 4);
  add_attributes(spec, options.attributes);
  std::vector<Rgba8> codes(image.pixels());
  std::transform(image.colour.data(), image.colour.data() + image.pixels(), codes.begin(),
                 straight);
  write_values(path, spec, OIIO::TypeDesc::UINT8, codes.data());
}

void write_jpeg(const std::filesystem::path& path, const Image8& image,
                const WriteOptions& options) {
  OIIO::ImageSpec spec = spec_of_codes(image.width, image.height, 3);
  spec.attribute("CompressionQuality", options.jpeg_quality);
  spec.attribute("jpeg:subsampling", "4:4:4");
  add_attributes(spec, options.attributes);
  std::vector<std::uint8_t> codes;
  codes.reserve(3 * image.pixels());
  for (const Rgba8& c : image.colour.span()) codes.insert(codes.end(), {c.r, c.g, c.b});
  write_values(path, spec, OIIO::TypeDesc::UINT8, codes.data());
}

void check_suffix(const std::filesystem::path& path) {
  if (is_picture_suffix(path)) return;
  std::string known;
  for (const char* suffix : kSuffixes) known += std::string(known.empty() ? "" : " ") + suffix;
  fail(path, "", "the suffix of a picture is one of " + known);
}

}  // namespace

std::span<const char* const> picture_suffixes() { return kSuffixes; }

bool is_picture_suffix(const std::filesystem::path& path) {
  const std::string suffix = lower_suffix(path);
  return std::find(kSuffixes.begin(), kSuffixes.end(), suffix) != kSuffixes.end();
}

void write_image(const std::filesystem::path& path, const Image8& image,
                 const WriteOptions& options) {
  assert(image.width >= 1 && image.height >= 1);
  check_suffix(path);
  const std::string suffix = lower_suffix(path);
  if (suffix == ".exr") {
    write_exr(path, to_float(image), options);
  } else if (suffix == ".jpg" || suffix == ".jpeg") {
    write_jpeg(path, image, options);
  } else {
    write_codes(path, image, options);
  }
}

void write_image(const std::filesystem::path& path, const ImageF& image,
                 const WriteOptions& options) {
  assert(image.width >= 1 && image.height >= 1);
  check_suffix(path);
  if (lower_suffix(path) == ".exr") {
    write_exr(path, image, options);
  } else {
    write_image(path, to_8bit(image), options);
  }
}

std::vector<std::byte> encode_png(int width, int height, std::span<const Rgba8> texels) {
  assert(width >= 1 && height >= 1);
  assert(texels.size() == static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  const auto output = OIIO::ImageOutput::create("png");
  if (!output || !output->set_ioproxy(&memory) ||
      !output->open("png", spec_of_codes(width, height, 4)) ||
      !output->write_image(OIIO::TypeDesc::UINT8, texels.data()) || !output->close()) {
    fail("png", "", output ? output->geterror() : OIIO::geterror());
  }
  std::vector<std::byte> result(bytes.size());
  std::transform(bytes.begin(), bytes.end(), result.begin(),
                 [](unsigned char c) { return static_cast<std::byte>(c); });
  return result;
}

}  // namespace delray::image
