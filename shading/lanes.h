// Vectors of up to sixteen floats and the arithmetic of shading/arithmetic.h over them: lane by
// lane the same operations in the same order, so that lanes and scalars agree to the last bit.
//
// Compiled once per instruction set, so it has a guard of Highway's kind.
#if defined(DELRAY_SHADING_LANES) == defined(HWY_TARGET_TOGGLE)
#ifdef DELRAY_SHADING_LANES
#undef DELRAY_SHADING_LANES
#else
#define DELRAY_SHADING_LANES
#endif

#include <hwy/highway.h>
#include <bit>
#include <cstring>

#include "shading/arithmetic.h"
#include "shading/points.h"

HWY_BEFORE_NAMESPACE();
namespace delray::shading {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using FloatTag = HWY_CAPPED(float, kBlockPoints);
using IntTag = hn::RebindToSigned<FloatTag>;
using F = hn::Vec<FloatTag>;
using I = hn::Vec<IntTag>;
using M = hn::Mask<FloatTag>;

HWY_INLINE F set(float x) { return hn::Set(FloatTag(), x); }
HWY_INLINE I set(std::int32_t x) { return hn::Set(IntTag(), x); }
HWY_INLINE F load(const Floats16& a, int i) { return hn::Load(FloatTag(), a.lane + i); }
HWY_INLINE int lanes() { return static_cast<int>(hn::Lanes(FloatTag())); }

// std::max and std::min, of NaN and of zeros of both signs as well.
HWY_INLINE F max_of(F a, F b) {
#if HWY_ARCH_X86 && HWY_TARGET != HWY_EMU128 && HWY_TARGET != HWY_SCALAR
  return hn::Max(b, a);  // the instruction gives its second operand where neither is greater
#else
  return hn::IfThenElse(hn::Lt(a, b), b, a);
#endif
}
HWY_INLINE F min_of(F a, F b) {
#if HWY_ARCH_X86 && HWY_TARGET != HWY_EMU128 && HWY_TARGET != HWY_SCALAR
  return hn::Min(b, a);
#else
  return hn::IfThenElse(hn::Lt(b, a), b, a);
#endif
}

HWY_INLINE F clamp01(F x) { return min_of(max_of(set(0.0F), x), set(1.0F)); }
HWY_INLINE F mix(F a, F b, F t) { return a + (b - a) * t; }
HWY_INLINE F to_float(I x) { return hn::ConvertTo(FloatTag(), x); }
HWY_INLINE I truncated(F x) { return hn::ConvertTo(IntTag(), x); }

HWY_INLINE I floor_to_int(F x) {
  const I i = truncated(x);
  return i + hn::VecFromMask(IntTag(), hn::RebindMask(IntTag(), hn::Lt(x, to_float(i))));
}

HWY_INLINE F pow5(F x) {
  const F x2 = x * x;
  return x2 * x2 * x;
}

HWY_INLINE F log2(F x) {
  x = max_of(x, set(0x1p-126F));
  const I bits = hn::BitCast(IntTag(), x);
  const I exponent = hn::ShiftRight<23>(bits - set(0x3F3504F3));
  const F m = hn::BitCast(FloatTag(), bits - hn::ShiftLeft<23>(exponent));
  const F s = (m - set(1.0F)) / (m + set(1.0F));
  const F s2 = s * s;
  const F p = set(2.88539008F) +
              s2 * (set(0.961798839F) + s2 * (set(0.576715186F) + s2 * set(0.431717697F)));
  return to_float(exponent) + s * p;
}

HWY_INLINE F atan2(F y, F x) {
  const F zero = set(0.0F);
  const F ax = hn::Abs(x), ay = hn::Abs(y);
  const F low = min_of(ax, ay), high = max_of(ax, ay);
  const M upper = hn::Gt(low, high * set(0.414213562F));
  const F t = hn::IfThenElse(upper, low - high, low) / hn::IfThenElse(upper, low + high, high);
  const F t2 = t * t;
  const F p = set(0.999999981F) +
              t2 * (set(-0.333327858F) +
                    t2 * (set(0.199740824F) + t2 * (set(-0.138484902F) + t2 * set(0.0797629181F))));
  F angle = t * p + hn::IfThenElse(upper, set(0.785398163F), zero);
  angle = hn::IfThenElse(hn::Gt(ay, ax), set(1.57079633F) - angle, angle);
  angle = hn::IfThenElse(hn::Lt(x, zero), set(kPi) - angle, angle);
  angle = hn::IfThenElse(hn::Lt(y, zero), hn::Neg(angle), angle);
  return hn::IfThenElse(hn::Eq(high, zero), zero, angle);
}

HWY_INLINE F acos(F x) {
  x = min_of(max_of(x, set(-1.0F)), set(1.0F));
  return atan2(hn::Sqrt((set(1.0F) - x) * (set(1.0F) + x)), x);
}

// Sines and cosines of a vector of angles.
struct SinCosLanes {
  F sin, cos;
};

HWY_INLINE SinCosLanes sin_cos(F x) {
  const I quarter = floor_to_int(x * set(0.636619772F) + set(0.5F));
  const F q = to_float(quarter);
  const F r = (x - q * set(1.5703125F)) - q * set(4.83826794897e-4F);
  const F r2 = r * r;
  const F s =
      r * (set(0.999999997F) +
           r2 * (set(-0.166666507F) + r2 * (set(0.00833203579F) + r2 * set(-0.000195039043F))));
  const F c =
      set(1.0F) +
      r2 * (set(-0.499999996F) +
            r2 * (set(0.0416666167F) + r2 * (set(-0.0013886618F) + r2 * set(2.43798312e-05F))));
  const FloatTag d;
  const M odd = hn::RebindMask(d, hn::Ne(quarter & set(1), set(0)));
  // Bit 1 of the quarter, and of the next one, are the signs.
  const F sign_of_sin = hn::BitCast(d, hn::ShiftLeft<30>(quarter & set(2)));
  const F sign_of_cos = hn::BitCast(d, hn::ShiftLeft<30>((quarter + set(1)) & set(2)));
  return {hn::Xor(hn::IfThenElse(odd, c, s), sign_of_sin),
          hn::Xor(hn::IfThenElse(odd, s, c), sign_of_cos)};
}

// Three vectors of floats: x, y, z or red, green, blue of the lanes.
struct F3 {
  F x, y, z;
};

HWY_INLINE F3 set(const glm::vec3& v) { return {set(v.x), set(v.y), set(v.z)}; }
HWY_INLINE F3 load(const Vectors16& v, int i) { return {load(v.x, i), load(v.y, i), load(v.z, i)}; }
HWY_INLINE F3 operator+(const F3& a, const F3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
HWY_INLINE F3 operator-(const F3& a, const F3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
HWY_INLINE F3 operator*(const F3& a, const F3& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
HWY_INLINE F3 operator*(const F3& a, F b) { return {a.x * b, a.y * b, a.z * b}; }
HWY_INLINE F3 negated(const F3& a) { return {hn::Neg(a.x), hn::Neg(a.y), hn::Neg(a.z)}; }
HWY_INLINE F3 mix(const F3& a, const F3& b, F t) { return a + (b - a) * t; }
HWY_INLINE F dot(const F3& a, const F3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
HWY_INLINE F3 cross(const F3& a, const F3& b) {
  return {a.y * b.z - b.y * a.z, a.z * b.x - b.z * a.x, a.x * b.y - b.x * a.y};
}
HWY_INLINE F3 choose(M m, const F3& yes, const F3& no) {
  return {hn::IfThenElse(m, yes.x, no.x), hn::IfThenElse(m, yes.y, no.y),
          hn::IfThenElse(m, yes.z, no.z)};
}
HWY_INLINE F3 where(M m, const F3& v) {
  return {hn::IfThenElseZero(m, v.x), hn::IfThenElseZero(m, v.y), hn::IfThenElseZero(m, v.z)};
}
HWY_INLINE M any_positive(const F3& v) {
  const F zero = set(0.0F);
  return hn::Or(hn::Or(hn::Gt(v.x, zero), hn::Gt(v.y, zero)), hn::Gt(v.z, zero));
}

// Lanes i, i + 1, ... of a block.
HWY_INLINE M mask_of(LaneMask mask, int i) {
  const IntTag d;
  HWY_ALIGN static constexpr std::int32_t kBits[kBlockPoints] = {
      1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024, 2048, 4096, 8192, 16384, 32768};
  const I bits = hn::Set(d, static_cast<std::int32_t>(mask)) & hn::Load(d, kBits + i);
  return hn::RebindMask(FloatTag(), hn::Ne(bits, hn::Zero(d)));
}
HWY_INLINE LaneMask bits_of(M mask, int i) {
  HWY_ALIGN std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(FloatTag(), mask, bytes);
  std::uint16_t bits;
  static_assert(std::endian::native == std::endian::little);  // one load, not two bytes
  std::memcpy(&bits, bytes, sizeof(bits));
  return static_cast<LaneMask>(bits) << i;
}

// Masked stores are very slow on some machines, and nobody else writes to the block.
HWY_INLINE void store(F v, M mask, int i, Floats16& to) {
  hn::Store(hn::IfThenElse(mask, v, load(to, i)), FloatTag(), to.lane + i);
}
HWY_INLINE void store(const F3& v, M mask, int i, Vectors16& to) {
  store(v.x, mask, i, to.x);
  store(v.y, mask, i, to.y);
  store(v.z, mask, i, to.z);
}

}  // namespace HWY_NAMESPACE
}  // namespace delray::shading
HWY_AFTER_NAMESPACE();

#endif
