// Reads pictures, textures and raw channels through OpenImageIO: finds colour, alpha and depth
// among the channels and converts them as io.h says. Degenerate: a file without R, G and B takes
// its first other channel as grey; pixels outside the display window are dropped.
#include <algorithm>
#include <string_view>

#include "image/openimageio/codec.h"
#include "image/openimageio/input_file.h"
#include "image/srgb.h"

namespace delray::image::openimageio {
namespace {

// Which channel of a file is what; -1: none.
struct Layout {
  int r = -1, g = -1, b = -1, a = -1, z = -1;
  bool is_colour(int c) const { return c == r || c == g || c == b || c == a || c == z; }
};

Layout find_layout(const OIIO::ImageSpec& spec) {
  const auto find = [&](std::string_view name) {
    const auto at = std::find(spec.channelnames.begin(), spec.channelnames.end(), name);
    return at == spec.channelnames.end() ? -1 : static_cast<int>(at - spec.channelnames.begin());
  };
  Layout layout{find("R"), find("G"), find("B"), find("A"), find("Z")};
  if (layout.a < 0) layout.a = spec.alpha_channel;
  if (layout.z < 0) layout.z = spec.z_channel;
  if (layout.r < 0 && layout.g < 0 && layout.b < 0) {
    for (int c = 0; c < spec.nchannels && layout.r < 0; ++c) {
      if (c != layout.a && c != layout.z) layout.r = layout.g = layout.b = c;
    }
  }
  return layout;
}

bool is_integer(const OIIO::ImageSpec& spec) { return !spec.format.is_floating_point(); }

std::vector<Attribute> attributes_of(const OIIO::ImageSpec& spec) {
  std::vector<Attribute> result;
  for (const OIIO::ParamValue& value : spec.extra_attribs) {
    if (value.type() == OIIO::TypeString) {
      result.push_back({value.name().string(), std::string(value.get_ustring().string())});
    } else if (value.type() == OIIO::TypeDesc::DOUBLE) {
      result.push_back({value.name().string(), *static_cast<const double*>(value.data())});
    } else if (value.type() == OIIO::TypeInt) {
      result.push_back({value.name().string(), static_cast<double>(value.get_int())});
    } else if (value.type() == OIIO::TypeFloat) {
      result.push_back({value.name().string(), static_cast<double>(value.get_float())});
    }
  }
  return result;
}

// The colour of the pixel whose channels are at `values`.
class ColourReader {
 public:
  ColourReader(const OIIO::ImageSpec& spec, const Layout& layout)
      : layout_(layout),
        integer_(is_integer(spec)),
        eight_bits_(spec.format == OIIO::TypeDesc::UINT8),
        straight_(spec.get_int_attribute("oiio:UnassociatedAlpha") != 0) {}

  RgbaF operator()(const float* values) const {
    const auto value = [&](int c) { return c < 0 ? 0.0F : values[c]; };
    RgbaF colour{value(layout_.r), value(layout_.g), value(layout_.b),
                 layout_.a < 0 ? 1.0F : values[layout_.a]};
    bool straight = straight_;
    if (integer_) {
      // Associated alpha has multiplied the codes, not the light.
      const float scale = !straight && colour.a > 0.0F ? 1.0F / colour.a : 1.0F;
      for (float* channel : {&colour.r, &colour.g, &colour.b}) *channel = decode(*channel * scale);
      straight = true;
    }
    if (straight && colour.a != 1.0F) {
      for (float* channel : {&colour.r, &colour.g, &colour.b}) *channel *= colour.a;
    }
    return colour;
  }

 private:
  float decode(float value) const {
    if (eight_bits_) return decode_srgb(encode_alpha(value));
    return decode_srgb_value(std::min(value, 1.0F));
  }

  Layout layout_;
  bool integer_, eight_bits_, straight_;
};

Picture read_all(InputFile& file, bool with_channels) {
  const OIIO::ImageSpec& spec = file.spec();
  const Layout layout = find_layout(spec);
  const ColourReader colour_of(spec, layout);
  Picture picture;
  picture.attributes = attributes_of(spec);
  const int width = spec.full_width > 0 ? spec.full_width : spec.width;
  const int height = spec.full_height > 0 ? spec.full_height : spec.height;
  std::vector<int> extra;
  for (int c = 0; with_channels && c < spec.nchannels; ++c) {
    if (!layout.is_colour(c)) extra.push_back(c);
  }
  file.require_memory(static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height),
                      sizeof(RgbaF) + sizeof(float) * (1 + extra.size()));
  picture.image = ImageF(width, height);
  clear(picture.image);
  for (const int c : extra) {
    picture.channels.push_back({spec.channelnames[static_cast<std::size_t>(c)],
                                std::vector<float>(picture.image.pixels())});
  }
  const int left = spec.x - spec.full_x, top = spec.y - spec.full_y;
  const int first = std::max(0, -left), last = std::min(spec.width, width - left);
  file.read<float>(OIIO::TypeDesc::FLOAT, [&](int y, int rows, const float* values) {
    for (int row = 0; row < rows; ++row) {
      const int target_y = top + y + row;
      if (target_y < 0 || target_y >= height) continue;
      for (int x = first; x < last; ++x) {
        const float* pixel =
            values + (static_cast<std::size_t>(row) * static_cast<std::size_t>(spec.width) +
                      static_cast<std::size_t>(x)) *
                         static_cast<std::size_t>(spec.nchannels);
        const std::size_t i = static_cast<std::size_t>(target_y) * static_cast<std::size_t>(width) +
                              static_cast<std::size_t>(left + x);
        const RgbaF colour = colour_of(pixel);
        picture.image.colour[i] = colour;
        picture.image.depth[i] = layout.z >= 0     ? pixel[layout.z]
                                 : colour.a > 0.0F ? 0.0F
                                                   : kEmptyDepth;
        for (std::size_t k = 0; k < extra.size(); ++k) {
          picture.channels[k].values[i] = pixel[extra[k]];
        }
      }
    }
  });
  return picture;
}

Texels read_codes(InputFile& file) {
  const OIIO::ImageSpec& spec = file.spec();
  const Layout layout = find_layout(spec);
  const bool integer = is_integer(spec);
  const bool straight = spec.get_int_attribute("oiio:UnassociatedAlpha") != 0;
  Texels result{spec.width, spec.height, {}};
  file.require_memory(spec.image_pixels(), sizeof(Rgba8));
  const auto all = static_cast<std::size_t>(spec.image_pixels());
  result.texels.reserve(all + all / 3 + 1);  // untouched room for smaller levels
  file.read<float>(OIIO::TypeDesc::FLOAT, [&](int, int rows, const float* values) {
    const std::size_t pixels =
        static_cast<std::size_t>(rows) * static_cast<std::size_t>(spec.width);
    for (std::size_t i = 0; i < pixels; ++i, values += spec.nchannels) {
      const float alpha = layout.a < 0 ? 1.0F : values[layout.a];
      const float scale = !straight && alpha > 0.0F ? 1.0F / alpha : 1.0F;
      const auto code = [&](int c) {
        const float value = c < 0 ? 0.0F : values[c] * scale;
        return integer ? encode_alpha(value) : encode_srgb(value);
      };
      result.texels.push_back(
          {code(layout.r), code(layout.g), code(layout.b), encode_alpha(alpha)});
    }
  });
  return result;
}

// Values of type T, which is OpenImageIO's `type`, as they are.
template <class T>
std::vector<double> read_numbers(InputFile& file, OIIO::TypeDesc type) {
  const OIIO::ImageSpec& spec = file.spec();
  std::vector<double> numbers;
  file.require_memory(spec.image_pixels(),
                      sizeof(double) * static_cast<std::size_t>(spec.nchannels));
  numbers.reserve(spec.image_pixels() * static_cast<std::size_t>(spec.nchannels));
  file.read<T>(type, [&](int, int rows, const T* values) {
    const std::size_t count = static_cast<std::size_t>(rows) *
                              static_cast<std::size_t>(spec.width) *
                              static_cast<std::size_t>(spec.nchannels);
    numbers.insert(numbers.end(), values, values + count);
  });
  return numbers;
}

std::vector<double> read_numbers(InputFile& file) {
  const OIIO::TypeDesc type = file.spec().format;
  switch (type.basetype) {
    case OIIO::TypeDesc::UINT8:
      return read_numbers<std::uint8_t>(file, type);
    case OIIO::TypeDesc::INT8:
      return read_numbers<std::int8_t>(file, type);
    case OIIO::TypeDesc::UINT16:
      return read_numbers<std::uint16_t>(file, type);
    case OIIO::TypeDesc::INT16:
      return read_numbers<std::int16_t>(file, type);
    case OIIO::TypeDesc::UINT32:
      return read_numbers<std::uint32_t>(file, type);
    case OIIO::TypeDesc::INT32:
      return read_numbers<std::int32_t>(file, type);
    case OIIO::TypeDesc::HALF:
    case OIIO::TypeDesc::FLOAT:
      return read_numbers<float>(file, OIIO::TypeDesc::FLOAT);
    case OIIO::TypeDesc::DOUBLE:
      return read_numbers<double>(file, type);
    default:
      file.fail("holds values of a type that cannot be read");
  }
}

}  // namespace

PictureInfo read_info(const Encoded& from) {
  const InputFile file(from);
  const OIIO::ImageSpec& spec = file.spec();
  return {spec.width,        spec.height,        file.format(), std::string(spec.format.c_str()),
          spec.channelnames, attributes_of(spec)};
}

Picture read_picture(const Encoded& from, bool with_channels) {
  InputFile file(from);
  return read_all(file, with_channels);
}

Texels read_texels(const Encoded& from) {
  InputFile file(from);
  return read_codes(file);
}

RawChannels read_float_channels(const Encoded& from) {
  InputFile file(from);
  const OIIO::ImageSpec& spec = file.spec();
  return {spec.width, spec.height, spec.channelnames, read_numbers(file)};
}

}  // namespace delray::image::openimageio
