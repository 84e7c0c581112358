// Writes EXR, TIFF and JPEG through OpenImageIO, without the time of writing, so that equal
// pictures give equal files.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <iterator>

#include "files/error.h"
#include "image/openimageio/codec.h"
#include "image/srgb.h"

namespace delray::image::openimageio {
namespace {

// The message of OpenImageIO, with the name that the user knows in place of the temporary one.
[[noreturn]] void fail(const Target& target, std::string what) {
  const std::string temporary = target.file.string();
  for (std::size_t at; !temporary.empty() && (at = what.find(temporary)) != std::string::npos;) {
    what.replace(at, temporary.size(), target.name);
  }
  throw files::FileError(files::Cause::device, target.name, "", "cannot write: " + what);
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

// Writes rows of interleaved values, all in one call; to memory where one is given.
void write_values(const Target& target, const OIIO::ImageSpec& spec, OIIO::TypeDesc type,
                  const void* values, OIIO::Filesystem::IOProxy* memory = nullptr) {
  const std::string file = target.file.string();
  const auto output = OIIO::ImageOutput::create(file);
  if (!output) fail(target, OIIO::geterror());
  try {
    if (memory != nullptr && !output->set_ioproxy(memory)) fail(target, output->geterror());
    const bool written = output->open(file, spec) && output->write_image(type, values);
    // Also after a failure, so that the file is closed before it is removed.
    const bool closed = output->close();
    if (!written || !closed || output->has_error()) fail(target, output->geterror());
  } catch (const files::FileError&) {
    throw;
  } catch (const std::exception& error) {
    fail(target, error.what());
  }
}

OIIO::ImageSpec spec_of_codes(int width, int height, int channels) {
  OIIO::ImageSpec spec(width, height, channels, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  if (channels == 4) spec.attribute("oiio:UnassociatedAlpha", 1);
  return spec;
}

OIIO::ImageSpec spec_of_light(int width, int height, std::span<const Channel> channels) {
  OIIO::ImageSpec spec(width, height, static_cast<int>(5 + channels.size()), OIIO::TypeDesc::FLOAT);
  spec.channelnames = {"R", "G", "B", "A", "Z"};
  spec.alpha_channel = 3;
  spec.z_channel = 4;
  for (const Channel& channel : channels) spec.channelnames.push_back(channel.name);
  return spec;
}

class Tiles final : public RowSink {
 public:
  Tiles(const Target& target, const OIIO::ImageSpec& spec)
      : target_(target), spec_(spec), row_(spec.scanline_bytes(true)) {
    spec_.tile_width = spec_.tile_height = kSide;
    guarded([&] {
      output_ = OIIO::ImageOutput::create(target_.file.string());
      if (!output_) fail(target_, OIIO::geterror());
      return output_->open(target_.file.string(), spec_);
    });
  }

  void append(const void* values, int count) override {
    const auto* bytes = static_cast<const std::byte*>(values);
    for (int left = count; left > 0;) {
      const int had = static_cast<int>(waiting_.size() / row_);
      const int taken = std::min(left, std::min(kSide, spec_.height - written_) - had);
      const std::byte* const end = bytes + row_ * static_cast<std::size_t>(taken);
      waiting_.insert(waiting_.end(), bytes, end);
      bytes = end;
      left -= taken;
      if (had + taken == std::min(kSide, spec_.height - written_)) write();
    }
  }

  void close() override {
    guarded([&] { return output_->close(); });
  }

 private:
  static constexpr int kSide = 128;

  void write() {
    const int end = written_ + static_cast<int>(waiting_.size() / row_);
    guarded([&] {
      return output_->write_tiles(0, spec_.width, written_, end, 0, 1, spec_.format,
                                  waiting_.data());
    });
    written_ = end;
    waiting_.clear();
  }

  template <class F>
  void guarded(F&& f) {
    try {
      if (!f() || output_->has_error()) fail(target_, output_->geterror());
    } catch (const files::FileError&) {
      throw;
    } catch (const std::exception& error) {
      fail(target_, error.what());
    }
  }

  Target target_;
  OIIO::ImageSpec spec_;
  std::size_t row_;  // bytes
  std::unique_ptr<OIIO::ImageOutput> output_;
  std::vector<std::byte> waiting_;  // rows of a row of tiles that is not complete
  int written_ = 0;                 // rows
};

}  // namespace

void write_exr(const Target& target, const ImageF& image, const WriteOptions& options) {
  const std::size_t channels = 5 + options.channels.size();
  OIIO::ImageSpec spec = spec_of_light(image.width, image.height, options.channels);
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
  write_values(target, spec, OIIO::TypeDesc::FLOAT, values.data());
}

void write_tiff(const Target& target, int width, int height, std::span<const Rgba8> texels,
                const WriteOptions& options) {
  OIIO::ImageSpec spec = spec_of_codes(width, height, 4);
  add_attributes(spec, options.attributes);
  write_values(target, spec, OIIO::TypeDesc::UINT8, texels.data());
}

std::unique_ptr<RowSink> open_rows(const Target& target, int width, int height, bool is_exr,
                                   const WriteOptions& options) {
  // Compression saves some, but nobody knows how much before.
  constexpr std::uint64_t kLargestTiff = std::uint64_t{3} << 30;
  OIIO::ImageSpec spec =
      is_exr ? spec_of_light(width, height, {}) : spec_of_codes(width, height, 4);
  add_attributes(spec, options.attributes);
  if (spec.image_bytes(true) > kLargestTiff) spec.attribute("tiff:bigtiff", 1);
  return std::make_unique<Tiles>(target, spec);
}

// libjpeg ends the program when it cannot write to a file, so it never writes to one.
std::vector<std::byte> encode_jpeg(const std::string& name, const Image8& image,
                                   const WriteOptions& options) {
  OIIO::ImageSpec spec = spec_of_codes(image.width, image.height, 3);
  spec.attribute("CompressionQuality", options.jpeg_quality);
  spec.attribute("jpeg:subsampling", "4:4:4");
  add_attributes(spec, options.attributes);
  std::vector<std::uint8_t> codes;
  codes.reserve(3 * image.pixels());
  for (const Rgba8& c : image.colour.span()) codes.insert(codes.end(), {c.r, c.g, c.b});
  std::vector<unsigned char> encoded;
  OIIO::Filesystem::IOVecOutput memory(encoded);
  write_values({"picture.jpg", name}, spec, OIIO::TypeDesc::UINT8, codes.data(), &memory);
  const auto bytes = std::as_bytes(std::span(encoded));
  return {bytes.begin(), bytes.end()};
}

}  // namespace delray::image::openimageio
