// What the interface tells of images: sizes, formats, planes, and copies in another format.
#include "icet/image.h"

#include <cstring>

#include "icet/error.h"
#include "icet/pixels.h"

namespace delray::icet {
namespace {

Image* image_of(IceTImage handle) { return static_cast<Image*>(handle.opaque_internals); }

Image& existing(IceTImage handle) {
  Image* const image = image_of(handle);
  if (image == nullptr) throw Error(ICET_INVALID_OPERATION, "the image is null");
  return *image;
}

IceTUByte* bytes_of(IceTImage handle) {
  return guarded([&]() -> IceTUByte* {
    Image& image = existing(handle);
    if (image.colour_format != ICET_IMAGE_COLOR_RGBA_UBYTE)
      throw Error(ICET_INVALID_OPERATION, "the image has no colours of bytes");
    return &image.bytes.colour.data()->r;
  });
}

IceTFloat* floats_of(IceTImage handle) {
  return guarded([&]() -> IceTFloat* {
    Image& image = existing(handle);
    if (!image.is_float())
      throw Error(ICET_INVALID_OPERATION, "the image has no colours of floats");
    return image.is_rgb() ? image.rgb.data() : &image.floats.colour.data()->r;
  });
}

IceTFloat* depth_of(IceTImage handle) {
  return guarded([&]() -> IceTFloat* {
    Image& image = existing(handle);
    if (image.depth_format == ICET_IMAGE_DEPTH_NONE)
      throw Error(ICET_INVALID_OPERATION, "the image has no depth");
    return image.depth();
  });
}

Image& with_colour(IceTImage handle) {
  Image& image = existing(handle);
  if (image.colour_format == ICET_IMAGE_COLOR_NONE)
    throw Error(ICET_INVALID_OPERATION, "the image has no colours");
  return image;
}

void copy_as_bytes(const Image& image, IceTUByte* to) {
  if (!image.is_float()) {
    std::memcpy(to, image.bytes.colour.data(), image.pixels() * 4);
    return;
  }
  const std::size_t channels = image.is_rgb() ? 3 : 4;
  const float* from = image.is_rgb() ? image.rgb.data() : &image.floats.colour.data()->r;
  for (std::size_t i = 0; i < image.pixels(); ++i, from += channels, to += 4) {
    for (std::size_t k = 0; k < 4; ++k) to[k] = k < channels ? byte_of(from[k]) : 255;
  }
}

void copy_as_floats(const Image& image, float* to, std::size_t channels) {
  const std::size_t pixels = image.pixels();
  const auto copy = [&](std::size_t there, auto&& value) {
    for (std::size_t i = 0; i < pixels; ++i) {
      for (std::size_t k = 0; k < channels; ++k) {
        to[i * channels + k] = k < there ? value(i * there + k) : 1.0F;
      }
    }
  };
  if (!image.is_float()) {
    const IceTUByte* const from = &image.bytes.colour.data()->r;
    copy(4, [&](std::size_t i) { return static_cast<float>(from[i]) / 255.0F; });
  } else if (image.is_rgb()) {
    copy(3, [&](std::size_t i) { return image.rgb[i]; });
  } else {
    const float* const from = &image.floats.colour.data()->r;
    copy(4, [&](std::size_t i) { return from[i]; });
  }
}

}  // namespace
}  // namespace delray::icet

using delray::icet::Error;
using delray::icet::guarded;
using delray::icet::image_of;

extern "C" {

IceTImage icetImageNull(void) { return IceTImage{nullptr}; }

IceTBoolean icetImageIsNull(const IceTImage image) {
  return image_of(image) == nullptr ? ICET_TRUE : ICET_FALSE;
}

IceTEnum icetImageGetColorFormat(const IceTImage image) {
  return image_of(image) == nullptr ? IceTEnum{ICET_IMAGE_COLOR_NONE}
                                    : image_of(image)->colour_format;
}

IceTEnum icetImageGetDepthFormat(const IceTImage image) {
  return image_of(image) == nullptr ? IceTEnum{ICET_IMAGE_DEPTH_NONE}
                                    : image_of(image)->depth_format;
}

IceTSizeType icetImageGetWidth(const IceTImage image) {
  return image_of(image) == nullptr ? 0 : image_of(image)->width;
}

IceTSizeType icetImageGetHeight(const IceTImage image) {
  return image_of(image) == nullptr ? 0 : image_of(image)->height;
}

IceTSizeType icetImageGetNumPixels(const IceTImage image) {
  return icetImageGetWidth(image) * icetImageGetHeight(image);
}

IceTUByte* icetImageGetColorub(IceTImage image) { return delray::icet::bytes_of(image); }
IceTUInt* icetImageGetColorui(IceTImage image) {
  return reinterpret_cast<IceTUInt*>(delray::icet::bytes_of(image));
}
IceTFloat* icetImageGetColorf(IceTImage image) { return delray::icet::floats_of(image); }
IceTFloat* icetImageGetDepthf(IceTImage image) { return delray::icet::depth_of(image); }
const IceTUByte* icetImageGetColorcub(const IceTImage image) { return icetImageGetColorub(image); }
const IceTUInt* icetImageGetColorcui(const IceTImage image) { return icetImageGetColorui(image); }
const IceTFloat* icetImageGetColorcf(const IceTImage image) { return icetImageGetColorf(image); }
const IceTFloat* icetImageGetDepthcf(const IceTImage image) { return icetImageGetDepthf(image); }

void icetImageCopyColorub(const IceTImage image, IceTUByte* buffer, IceTEnum color_format) {
  guarded([&] {
    if (color_format != ICET_IMAGE_COLOR_RGBA_UBYTE)
      throw Error(ICET_INVALID_ENUM, "the format is not one of bytes");
    delray::icet::copy_as_bytes(delray::icet::with_colour(image), buffer);
  });
}

void icetImageCopyColorf(const IceTImage image, IceTFloat* buffer, IceTEnum color_format) {
  guarded([&] {
    if (color_format != ICET_IMAGE_COLOR_RGBA_FLOAT && color_format != ICET_IMAGE_COLOR_RGB_FLOAT)
      throw Error(ICET_INVALID_ENUM, "the format is not one of floats");
    delray::icet::copy_as_floats(delray::icet::with_colour(image), buffer,
                                 color_format == ICET_IMAGE_COLOR_RGB_FLOAT ? 3 : 4);
  });
}

void icetImageCopyDepthf(const IceTImage image, IceTFloat* buffer, IceTEnum depth_format) {
  guarded([&] {
    if (depth_format != ICET_IMAGE_DEPTH_FLOAT)
      throw Error(ICET_INVALID_ENUM, "the format is not one of floats");
    delray::icet::Image& from = delray::icet::existing(image);
    if (from.depth_format == ICET_IMAGE_DEPTH_NONE)
      throw Error(ICET_INVALID_OPERATION, "the image has no depth");
    std::memcpy(buffer, from.depth(), from.pixels() * sizeof(float));
  });
}

}  // extern "C"
