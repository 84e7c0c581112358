// shading/texture.h over lanes. Compiled once per instruction set.
#if defined(DELRAY_SHADING_TEXTURE_LANES) == defined(HWY_TARGET_TOGGLE)
#ifdef DELRAY_SHADING_TEXTURE_LANES
#undef DELRAY_SHADING_TEXTURE_LANES
#else
#define DELRAY_SHADING_TEXTURE_LANES
#endif

#include <limits>

#include "shading/lanes.h"
#include "shading/lanes/texel_values.h"
#include "shading/texture.h"

HWY_BEFORE_NAMESPACE();
namespace delray::shading {
namespace HWY_NAMESPACE {

using Wrap = scenes::Texture::Wrap;

struct TexelLanes {
  F3 colour;
  F alpha;
};

struct FootprintLanes {
  F dx_u, dx_v, dy_u, dy_v;
};

HWY_INLINE F fold(F u, Wrap wrap) {
  u = hn::IfThenElseZero(hn::Le(hn::Abs(u), set(0x1p24F)), u);
  switch (wrap) {
    case Wrap::repeat:
      return u - to_float(floor_to_int(u));
    case Wrap::mirror: {
      const F t = u - set(2.0F) * to_float(floor_to_int(u * set(0.5F)));
      return hn::IfThenElse(hn::Gt(t, set(1.0F)), set(2.0F) - t, t);
    }
    case Wrap::clamp:
      break;
  }
  return clamp01(u);
}

HWY_INLINE F mip_level(const Texture& texture, const FootprintLanes& f) {
  const F width = set(static_cast<float>(texture.levels[0].width));
  const F height = set(static_cast<float>(texture.levels[0].height));
  const F last = set(static_cast<float>(texture.levels.size() - 1));
  const F dx_u = f.dx_u * width, dx_v = f.dx_v * height;
  const F dy_u = f.dy_u * width, dy_v = f.dy_v * height;
  const F squared = max_of(dx_u * dx_u + dx_v * dx_v, dy_u * dy_u + dy_v * dy_v);
  const M finite = hn::Le(squared, set(std::numeric_limits<float>::max()));
  const F level = hn::IfThenElse(finite, min_of(set(0.5F) * log2(squared), last), last);
  return hn::IfThenZeroElse(hn::Le(squared, set(1.0F)), level);
}

// Where the four texels around each lane's point are in a level of its own, and the weights of the
// right column and the lower row.
struct Corners {
  alignas(64) std::uint32_t top_left[kBlockPoints], top_right[kBlockPoints];
  alignas(64) std::uint32_t bottom_left[kBlockPoints], bottom_right[kBlockPoints];
  alignas(64) float x[kBlockPoints], y[kBlockPoints];
};

struct PairLanes {
  I first, second;
  F weight;
};

HWY_INLINE PairLanes find_pair(F folded, I size, Wrap wrap) {
  const F x = folded * to_float(size) - set(0.5F);
  const I i = floor_to_int(x);
  const I zero = set(0), last = size - set(1), next = i + set(1);
  const bool repeats = wrap == Wrap::repeat;
  return {hn::IfThenElse(hn::Lt(i, zero), repeats ? last : zero, i),
          hn::IfThenElse(hn::Gt(next, last), repeats ? zero : last, next), x - to_float(i)};
}

HWY_INLINE void store_offset(I row, I column, std::uint32_t* offset) {
  hn::Store(hn::BitCast(hn::RebindToUnsigned<FloatTag>(), row + column),
            hn::RebindToUnsigned<FloatTag>(), offset);
}

HWY_INLINE void find_corners(const Texture& texture, F u, F v, I level, Corners& corners) {
  const I width = hn::Max(hn::Shr(set(texture.levels[0].width), level), set(1));
  const I height = hn::Max(hn::Shr(set(texture.levels[0].height), level), set(1));
  const PairLanes x = find_pair(u, width, texture.wrap_u);
  const PairLanes y = find_pair(v, height, texture.wrap_v);
  const I top = y.first * width, bottom = y.second * width;
  store_offset(top, x.first, corners.top_left);
  store_offset(top, x.second, corners.top_right);
  store_offset(bottom, x.first, corners.bottom_left);
  store_offset(bottom, x.second, corners.bottom_right);
  hn::Store(x.weight, FloatTag(), corners.x);
  hn::Store(y.weight, FloatTag(), corners.y);
}

// The four channels of one texel.
#if HWY_TARGET == HWY_SCALAR
using Texel = glm::vec4;

HWY_INLINE Texel set_texel(float x) { return Texel(x); }
HWY_INLINE Texel make_texel(float r, float g, float b, float a) { return {r, g, b, a}; }
HWY_INLINE Texel codes_of(const image::Rgba8& t) { return {t.r, t.g, t.b, t.a}; }
HWY_INLINE Texel load_texel(const glm::vec4& t) { return t; }
HWY_INLINE void store(const Texel& texel, float* to) {
  for (int k = 0; k < 4; ++k) to[k] = texel[k];
}
#else
using TexelTag = hn::FixedTag<float, 4>;
using Texel = hn::Vec<TexelTag>;

HWY_INLINE Texel set_texel(float x) { return hn::Set(TexelTag(), x); }
HWY_INLINE Texel make_texel(float r, float g, float b, float a) {
  const TexelTag d;
  const Texel rg = hn::OddEven(hn::Set(d, g), hn::Set(d, r));
  const Texel ba = hn::OddEven(hn::Set(d, a), hn::Set(d, b));
  return hn::ConcatLowerLower(d, ba, rg);
}
HWY_INLINE Texel codes_of(const image::Rgba8& t) {
  const hn::FixedTag<std::uint8_t, 4> bytes;
  const hn::FixedTag<std::int32_t, 4> integers;
  return hn::ConvertTo(TexelTag(), hn::PromoteTo(integers, hn::LoadU(bytes, &t.r)));
}
HWY_INLINE Texel load_texel(const glm::vec4& t) { return hn::LoadU(TexelTag(), &t.x); }
HWY_INLINE void store(Texel texel, float* to) { hn::Store(texel, TexelTag(), to); }
#endif

// How texels are read; each has `value`, the numbers that are filtered, and of these `most` stands
// for 1 in colours and alpha.
struct SrgbTexels {
  const image::Rgba8* texels;
  const float* colours = texel_values(true);
  const float* codes = texel_values(false);
  static constexpr float kMostColour = 1.0F, kMostAlpha = 255.0F;

  HWY_INLINE Texel value(std::size_t i) const {
    const image::Rgba8& t = texels[i];
    return make_texel(colours[t.r], colours[t.g], colours[t.b], codes[t.a]);
  }
};

struct DataTexels {
  const image::Rgba8* texels;
  static constexpr float kMostColour = 255.0F, kMostAlpha = 255.0F;

  HWY_INLINE Texel value(std::size_t i) const { return codes_of(texels[i]); }
};

struct RadianceTexels {
  const glm::vec4* texels;
  static constexpr float kMostColour = 1.0F, kMostAlpha = 1.0F;

  HWY_INLINE Texel value(std::size_t i) const { return load_texel(texels[i]); }
};

template <class Texels>
HWY_INLINE Texel bilinear(const Texels& texels, std::size_t first, const Corners& at, int k) {
  const Texel a = texels.value(first + at.top_left[k]);
  const Texel b = texels.value(first + at.top_right[k]);
  const Texel c = texels.value(first + at.bottom_left[k]);
  const Texel d = texels.value(first + at.bottom_right[k]);
  const Texel x = set_texel(at.x[k]), y = set_texel(at.y[k]);
  const Texel upper = a + (b - a) * x;
  const Texel lower = c + (d - c) * x;
  return upper + (lower - upper) * y;
}

// One point after the other: four channels fill a vector of their own, and a gather would take as
// long. Lanes that are not active cost nothing and get zeros.
template <class Texels>
inline HWY_NOINLINE TexelLanes sample_texels(const Texture& texture, const Texels& texels, F u, F v,
                                             F level, M active) {
  const FloatTag d;
  u = fold(u, texture.wrap_u);
  v = fold(v, texture.wrap_v);
  const I base = truncated(level);
  alignas(64) std::int32_t bases[kBlockPoints];
  alignas(64) float weights[kBlockPoints];
  hn::Store(base, IntTag(), bases);
  hn::Store(level - to_float(base), d, weights);
  Corners sharp, blurred;
  find_corners(texture, u, v, base, sharp);
  find_corners(texture, u, v, base + set(1), blurred);

  alignas(64) float out[4 * kBlockPoints] = {};
  for (LaneMask rest = bits_of(active, 0); rest != 0; rest &= rest - 1) {
    const int k = std::countr_zero(rest);
    const Texture::Level* at = texture.levels.data() + bases[k];
    Texel colour = bilinear(texels, at->first, sharp, k);
    if (weights[k] != 0.0F) {
      const Texel other = bilinear(texels, at[1].first, blurred, k);
      colour = colour + (other - colour) * set_texel(weights[k]);
    }
    store(colour, out + 4 * k);
  }
  TexelLanes result;
  hn::LoadInterleaved4(d, out, result.colour.x, result.colour.y, result.colour.z, result.alpha);
  if constexpr (Texels::kMostAlpha != 1.0F) result.alpha = result.alpha / set(Texels::kMostAlpha);
  if constexpr (Texels::kMostColour != 1.0F) {
    const F most = set(Texels::kMostColour);
    result.colour = {result.colour.x / most, result.colour.y / most, result.colour.z / most};
  }
  return result;
}

// The alphas around each lane's point in one level: [corner][lane].
struct AlphaCorners {
  alignas(64) std::int32_t alpha[4][kBlockPoints];
};

HWY_INLINE void find_alphas(const image::Rgba8* texels, const Corners& at, int k,
                            AlphaCorners& to) {
  to.alpha[0][k] = texels[at.top_left[k]].a;
  to.alpha[1][k] = texels[at.top_right[k]].a;
  to.alpha[2][k] = texels[at.bottom_left[k]].a;
  to.alpha[3][k] = texels[at.bottom_right[k]].a;
}

HWY_INLINE F bilinear(const AlphaCorners& corners, const Corners& at) {
  const auto corner = [&](int j) { return to_float(hn::Load(IntTag(), corners.alpha[j])); };
  const F x = hn::Load(FloatTag(), at.x), y = hn::Load(FloatTag(), at.y);
  const F a = corner(0), c = corner(2);
  const F upper = a + (corner(1) - a) * x;
  const F lower = c + (corner(3) - c) * x;
  return upper + (lower - upper) * y;
}

// The alpha of `sample` alone.
inline HWY_NOINLINE F sample_alpha(const Texture& texture, F u, F v, F level, M active) {
  if (!texture.radiance.empty()) return set(1.0F);
  u = fold(u, texture.wrap_u);
  v = fold(v, texture.wrap_v);
  const I base = truncated(level);
  const F weight = level - to_float(base);
  const M between = hn::And(active, hn::Ne(weight, set(0.0F)));
  alignas(64) std::int32_t bases[kBlockPoints];
  hn::Store(base, IntTag(), bases);
  Corners sharp, blurred;
  AlphaCorners alphas{}, others{};
  const image::Rgba8* texels = texture.texels.data();
  find_corners(texture, u, v, base, sharp);
  for (LaneMask rest = bits_of(active, 0); rest != 0; rest &= rest - 1) {
    const int k = std::countr_zero(rest);
    find_alphas(texels + texture.levels[bases[k]].first, sharp, k, alphas);
  }
  F alpha = bilinear(alphas, sharp);
  if (!hn::AllFalse(FloatTag(), between)) {
    find_corners(texture, u, v, base + set(1), blurred);
    for (LaneMask rest = bits_of(between, 0); rest != 0; rest &= rest - 1) {
      const int k = std::countr_zero(rest);
      find_alphas(texels + texture.levels[bases[k] + 1].first, blurred, k, others);
    }
    const F other = bilinear(others, blurred);
    alpha = hn::IfThenElse(between, alpha + (other - alpha) * weight, alpha);
  }
  return alpha / set(255.0F);
}

// REQUIRES: level 0 has fewer than 2^32 texels.
HWY_INLINE TexelLanes sample(const Texture& texture, F u, F v, F level, M active) {
  if (!texture.radiance.empty()) {
    return sample_texels(texture, RadianceTexels{texture.radiance.data()}, u, v, level, active);
  }
  const image::Rgba8* const texels = texture.texels.data();
  return texture.srgb ? sample_texels(texture, SrgbTexels{texels}, u, v, level, active)
                      : sample_texels(texture, DataTexels{texels}, u, v, level, active);
}

}  // namespace HWY_NAMESPACE
}  // namespace delray::shading
HWY_AFTER_NAMESPACE();

#endif
