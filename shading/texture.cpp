// Builds mip levels by a box filter, and samples them trilinearly (Williams 1983).
//
// A level of even size averages pairs of texels, one of odd size weights three, so that every texel
// of the larger level counts as much as the others. Averages are taken in linear light and weighted
// by alpha; where alpha is 0 all over, colours count alike. O(texels) to build; a sample reads four
// texels, or eight between two levels.
#include "shading/texture.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <utility>

#include "image/srgb.h"
#include "shading/arithmetic.h"
#include "shading/lanes/texel_values.h"
#include "shading/take_shader.h"

namespace delray::shading {
namespace {

using Wrap = scenes::Texture::Wrap;

// How codes of one kind of texture become numbers from 0 to 1, and back.
struct Coding {
  std::array<float, 256> decode;
  std::uint8_t (*encode)(float);
};

Coding make_coding(float (*decode)(std::uint8_t), std::uint8_t (*encode)(float)) {
  Coding coding{{}, encode};
  for (int i = 0; i < 256; ++i) coding.decode[i] = decode(static_cast<std::uint8_t>(i));
  return coding;
}

const Coding kSrgb = make_coding(image::decode_srgb, image::encode_srgb);
const Coding kLinear = make_coding(image::decode_alpha, image::encode_alpha);

const std::array<float, 256> kCodes = [] {
  std::array<float, 256> codes;
  for (int i = 0; i < 256; ++i) codes[i] = static_cast<float>(i);
  return codes;
}();

const Coding& coding(bool srgb) { return srgb ? kSrgb : kLinear; }

// The source texels of texel i when `from` texels become `to` = max(1, from / 2), with weights that
// add up to 1: two halves, or three parts where `from` is odd.
struct Taps {
  std::array<int, 3> at;
  std::array<float, 3> weight;
};

Taps taps(int i, int from, int to) {
  if (from == 1) return {{0, 0, 0}, {1.0F, 0.0F, 0.0F}};
  if (from % 2 == 0) return {{2 * i, 2 * i + 1, 2 * i}, {0.5F, 0.5F, 0.0F}};
  const auto whole = static_cast<float>(from);
  return {{2 * i, 2 * i + 1, 2 * i + 2},
          {static_cast<float>(to - i) / whole, static_cast<float>(to) / whole,
           static_cast<float>(i + 1) / whole}};
}

void reduce(const image::Rgba8* from, const Texture::Level& source, image::Rgba8* to,
            const Texture::Level& target, const Coding& colours) {
  for (int y = 0; y < target.height; ++y) {
    const Taps rows = taps(y, source.height, target.height);
    for (int x = 0; x < target.width; ++x) {
      const Taps columns = taps(x, source.width, target.width);
      glm::vec3 weighted(0.0F), plain(0.0F);
      float alpha = 0.0F;
      for (int j = 0; j < 3; ++j) {
        const image::Rgba8* row = from + static_cast<std::size_t>(rows.at[j]) * source.width;
        for (int i = 0; i < 3; ++i) {
          const float weight = rows.weight[j] * columns.weight[i];
          if (weight == 0.0F) continue;
          const image::Rgba8 texel = row[columns.at[i]];
          const glm::vec3 colour(colours.decode[texel.r], colours.decode[texel.g],
                                 colours.decode[texel.b]);
          const float a = weight * kLinear.decode[texel.a];
          plain += colour * weight;
          weighted += colour * a;
          alpha += a;
        }
      }
      const glm::vec3 colour = alpha > 0.0F ? weighted / alpha : plain;
      to[static_cast<std::size_t>(y) * target.width + x] = {
          colours.encode(colour.x), colours.encode(colour.y), colours.encode(colour.z),
          kLinear.encode(alpha)};
    }
  }
}

// Brings u into [0, 1].
float fold(float u, Wrap wrap) {
  if (!(std::abs(u) <= 0x1p24F)) return 0.0F;
  switch (wrap) {
    case Wrap::repeat:
      return u - static_cast<float>(floor_to_int(u));
    case Wrap::mirror: {
      const float t = u - 2.0F * static_cast<float>(floor_to_int(u * 0.5F));
      return t > 1.0F ? 2.0F - t : t;
    }
    case Wrap::clamp:
      break;
  }
  return clamp01(u);
}

// The two texels beside a folded coordinate and the weight of the second.
struct Pair {
  int first, second;
  float weight;
};

Pair pair(float folded, int size, Wrap wrap) {
  const float x = folded * static_cast<float>(size) - 0.5F;
  const int i = floor_to_int(x);
  const float weight = x - static_cast<float>(i);
  // At the edges a mirrored texture meets itself, so it ends there as a clamped one does.
  const bool repeats = wrap == Wrap::repeat;
  const int first = i < 0 ? (repeats ? size - 1 : 0) : i;
  const int second = i + 1 >= size ? (repeats ? 0 : size - 1) : i + 1;
  return {first, second, weight};
}

// Of what `value` makes of texels: a number, or one for each channel.
template <class Texel, class Value>
auto bilinear(const Texture& texture, const Texel* all, float u, float v, int level,
              const Value& value) {
  const Texture::Level& at = texture.levels[level];
  const Texel* texels = all + at.first;
  const Pair x = pair(u, at.width, texture.wrap_u);
  const Pair y = pair(v, at.height, texture.wrap_v);
  const auto texel = [&](int i, int j) {
    return value(texels[static_cast<std::size_t>(j) * at.width + i]);
  };
  const auto a = texel(x.first, y.first), b = texel(x.second, y.first);
  const auto c = texel(x.first, y.second), d = texel(x.second, y.second);
  const auto top = a + (b - a) * x.weight;
  const auto bottom = c + (d - c) * x.weight;
  return top + (bottom - top) * y.weight;
}

template <class Texel, class Value>
auto filtered(const Texture& texture, const std::vector<Texel>& texels, const glm::vec2& uv,
              float level, const Value& value) {
  const float u = fold(uv.x, texture.wrap_u), v = fold(uv.y, texture.wrap_v);
  const auto base = static_cast<int>(level);
  const float weight = level - static_cast<float>(base);
  const auto sharp = bilinear(texture, texels.data(), u, v, base, value);
  if (weight == 0.0F) return sharp;
  return sharp + (bilinear(texture, texels.data(), u, v, base + 1, value) - sharp) * weight;
}

void reduce(const glm::vec4* from, const Texture::Level& source, glm::vec4* to,
            const Texture::Level& target) {
  for (int y = 0; y < target.height; ++y) {
    const Taps rows = taps(y, source.height, target.height);
    for (int x = 0; x < target.width; ++x) {
      const Taps columns = taps(x, source.width, target.width);
      glm::vec3 sum(0.0F);
      for (int j = 0; j < 3; ++j) {
        const glm::vec4* row = from + static_cast<std::size_t>(rows.at[j]) * source.width;
        for (int i = 0; i < 3; ++i) {
          sum += glm::vec3(row[columns.at[i]]) * (rows.weight[j] * columns.weight[i]);
        }
      }
      to[static_cast<std::size_t>(y) * target.width + x] = glm::vec4(sum, 1.0F);
    }
  }
}

// What all textures of the size have, without texels. `total` counts those of all levels.
Texture without_texels(const scenes::Texture& texture, int width, int height, std::size_t& total) {
  Texture result;
  result.srgb = texture.srgb;
  result.wrap_u = texture.wrap_u;
  result.wrap_v = texture.wrap_v;
  result.set = texture.set == 0 ? 0 : 1;
  total = 0;
  for (;;) {
    result.levels.push_back({total, width, height});
    total += static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    if (width == 1 && height == 1) break;
    width = std::max(1, width / 2);
    height = std::max(1, height / 2);
  }
  return result;
}

Texture with_radiance(const scenes::Texture& texture) {
  std::size_t total = 0;
  Texture result = without_texels(texture, texture.width, texture.height, total);
  result.radiance.reserve(total);
  for (const glm::vec3& light : texture.radiance) result.radiance.emplace_back(light, 1.0F);
  result.radiance.resize(total);
  for (std::size_t i = 1; i < result.levels.size(); ++i) {
    reduce(result.radiance.data() + result.levels[i - 1].first, result.levels[i - 1],
           result.radiance.data() + result.levels[i].first, result.levels[i]);
  }
  return result;
}

// Texels become those of level 0.
Texture with_levels(const scenes::Texture& texture, std::vector<image::Rgba8>&& texels) {
  const bool empty = texture.width < 1 || texture.height < 1 || texels.empty();
  std::size_t total = 0;
  Texture result =
      without_texels(texture, empty ? 1 : texture.width, empty ? 1 : texture.height, total);
  result.texels = std::move(texels);
  if (empty) {
    result.texels.assign(1, {255, 255, 255, 255});
  } else {
    const std::size_t first = result.levels.size() == 1 ? total : result.levels[1].first;
    result.opaque = std::all_of(result.texels.begin(),
                                result.texels.begin() + static_cast<std::ptrdiff_t>(first),
                                [](const image::Rgba8& texel) { return texel.a == 255; });
    result.texels.resize(total);
  }
  for (std::size_t i = 1; i < result.levels.size(); ++i) {
    reduce(result.texels.data() + result.levels[i - 1].first, result.levels[i - 1],
           result.texels.data() + result.levels[i].first, result.levels[i], coding(result.srgb));
  }
  return result;
}

}  // namespace

const float* texel_values(bool srgb) { return srgb ? kSrgb.decode.data() : kCodes.data(); }

Texture make_texture(const scenes::Texture& texture) {
  if (!texture.radiance.empty()) return with_radiance(texture);
  std::vector<image::Rgba8> texels;
  texels.reserve(texture.texels.size() + texture.texels.size() / 3 + 1);
  texels = texture.texels;
  return with_levels(texture, std::move(texels));
}

Texture take_texture(scenes::Texture& texture) {
  if (!texture.radiance.empty()) {
    Texture result = with_radiance(texture);
    texture.radiance = {};
    return result;
  }
  Texture result = with_levels(texture, std::move(texture.texels));
  texture.texels = {};
  return result;
}

float mip_level(const Texture& texture, const Footprint& footprint) {
  const glm::vec2 size(static_cast<float>(texture.levels[0].width),
                       static_cast<float>(texture.levels[0].height));
  const glm::vec2 dx = footprint.dx * size, dy = footprint.dy * size;
  const float squared = std::max(glm::dot(dx, dx), glm::dot(dy, dy));
  if (squared <= 1.0F) return 0.0F;
  const auto last = static_cast<float>(texture.levels.size() - 1);
  if (!(squared <= std::numeric_limits<float>::max())) return last;
  return std::min(0.5F * log2(squared), last);
}

glm::vec4 sample(const Texture& texture, const glm::vec2& uv, float level) {
  if (!texture.radiance.empty()) {
    return filtered(texture, texture.radiance, uv, level,
                    [](const glm::vec4& light) { return light; });
  }
  // Filtered are the linear light of sRGB colours, and codes of 0 to 255 of all else.
  const float* colours = texel_values(texture.srgb);
  const float* codes = texel_values(false);
  const glm::vec4 value = filtered(texture, texture.texels, uv, level, [&](const image::Rgba8& t) {
    return glm::vec4(colours[t.r], colours[t.g], colours[t.b], codes[t.a]);
  });
  return texture.srgb ? glm::vec4(glm::vec3(value), value.w / 255.0F) : value / 255.0F;
}

float sample_alpha(const Texture& texture, const glm::vec2& uv, float level) {
  if (!texture.radiance.empty()) return 1.0F;
  const auto code = [](const image::Rgba8& t) { return static_cast<float>(t.a); };
  return filtered(texture, texture.texels, uv, level, code) / 255.0F;
}

}  // namespace delray::shading
