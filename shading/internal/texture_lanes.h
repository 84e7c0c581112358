// shading/texture.h over lanes. Compiled once per instruction set.
#if defined(DELRAY_SHADING_TEXTURE_LANES) == defined(HWY_TARGET_TOGGLE)
#ifdef DELRAY_SHADING_TEXTURE_LANES
#undef DELRAY_SHADING_TEXTURE_LANES
#else
#define DELRAY_SHADING_TEXTURE_LANES
#endif

#include <limits>

#include "shading/internal/decode_table.h"
#include "shading/internal/lanes.h"
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

// The four texels around each lane's point in a level of its own, and the weights of the second
// column and row.
struct Corners {
  alignas(64) std::int32_t left[kBlockPoints], right[kBlockPoints];
  alignas(64) std::int32_t top[kBlockPoints], bottom[kBlockPoints];
  alignas(64) std::int32_t width[kBlockPoints];
  alignas(64) float x[kBlockPoints], y[kBlockPoints];
};

HWY_INLINE void find_pair(F folded, I size, Wrap wrap, std::int32_t* first, std::int32_t* second,
                          float* weight) {
  const FloatTag d;
  const IntTag di;
  const F x = folded * to_float(size) - set(0.5F);
  const I i = floor_to_int(x);
  const I zero = hn::Zero(di), last = size - set(1), next = i + set(1);
  const bool repeats = wrap == Wrap::repeat;
  hn::Store(hn::IfThenElse(hn::Lt(i, zero), repeats ? last : zero, i), di, first);
  hn::Store(hn::IfThenElse(hn::Gt(next, last), repeats ? zero : last, next), di, second);
  hn::Store(x - to_float(i), d, weight);
}

HWY_INLINE void find_corners(const Texture& texture, F u, F v, I level, Corners& corners) {
  const I width = hn::Max(hn::Shr(set(texture.levels[0].width), level), set(1));
  const I height = hn::Max(hn::Shr(set(texture.levels[0].height), level), set(1));
  find_pair(u, width, texture.wrap_u, corners.left, corners.right, corners.x);
  find_pair(v, height, texture.wrap_v, corners.top, corners.bottom, corners.y);
  hn::Store(width, IntTag(), corners.width);
}

// The four channels of one texel.
#if HWY_TARGET == HWY_SCALAR
using Texel = glm::vec4;

HWY_INLINE Texel set_texel(float x) { return Texel(x); }
HWY_INLINE Texel make_texel(float r, float g, float b, float a) { return {r, g, b, a}; }
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
HWY_INLINE void store(Texel texel, float* to) { hn::Store(texel, TexelTag(), to); }
#endif

struct Decoding {
  const float* colours;
  const float* alphas;
};

HWY_INLINE Texel decoded(const image::Rgba8& t, const Decoding& tables) {
  return make_texel(tables.colours[t.r], tables.colours[t.g], tables.colours[t.b],
                    tables.alphas[t.a]);
}

HWY_INLINE Texel bilinear(const image::Rgba8* texels, const Corners& at, int k,
                          const Decoding& tables) {
  const auto width = static_cast<std::size_t>(at.width[k]);
  const image::Rgba8* top = texels + static_cast<std::size_t>(at.top[k]) * width;
  const image::Rgba8* bottom = texels + static_cast<std::size_t>(at.bottom[k]) * width;
  const Texel a = decoded(top[at.left[k]], tables), b = decoded(top[at.right[k]], tables);
  const Texel c = decoded(bottom[at.left[k]], tables), d = decoded(bottom[at.right[k]], tables);
  const Texel x = set_texel(at.x[k]), y = set_texel(at.y[k]);
  const Texel upper = a + (b - a) * x;
  const Texel lower = c + (d - c) * x;
  return upper + (lower - upper) * y;
}

// Lanes that are not active cost nothing and get zeros. One point after the other: four channels
// fill a vector of their own, and a gather would take as long.
inline HWY_NOINLINE TexelLanes sample(const Texture& texture, F u, F v, F level, M active) {
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

  const Decoding tables{decode_table(texture.srgb), decode_table(false)};
  const image::Rgba8* texels = texture.texels.data();
  alignas(64) float out[4 * kBlockPoints] = {};
  for (LaneMask rest = bits_of(active, 0); rest != 0; rest &= rest - 1) {
    const int k = std::countr_zero(rest);
    const Texture::Level* at = texture.levels.data() + bases[k];
    Texel colour = bilinear(texels + at->first, sharp, k, tables);
    if (weights[k] != 0.0F) {
      const Texel other = bilinear(texels + at[1].first, blurred, k, tables);
      colour = colour + (other - colour) * set_texel(weights[k]);
    }
    store(colour, out + 4 * k);
  }
  TexelLanes result;
  hn::LoadInterleaved4(d, out, result.colour.x, result.colour.y, result.colour.z, result.alpha);
  return result;
}

}  // namespace HWY_NAMESPACE
}  // namespace delray::shading
HWY_AFTER_NAMESPACE();

#endif
