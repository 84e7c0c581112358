// Triangles side by side, with the arithmetic of Embree's robust intersection: Plücker coordinates
// of edges seen from the ray's origin (Platis and Theoharis 2003; Davidovic et al. 2012), operation
// by operation, so that what passes here and what it gives are Embree's to the last bit.
//
// Compiled once per instruction set, so it has a guard of Highway's kind: multiply-add is fused
// where Embree's kernels have it fused, and reciprocals begin with the machine's own estimate.
//
// Bounds. Let u = 2^-24, v0, v1, v2 the corners seen from the origin (as rounded: they are the
// same numbers in all that follows), e the edges, D the direction. An edge function D * (e x s), s
// the sum of the edge's ends, is rounded once for each of e and s, twice for the cross product and
// three times for the scalar product: less than 9u |D||e||s| in all. kNoise |D| e v, with e the
// longest edge and v the farthest corner (|s| <= 2v), is more than that. The depth of the plane is
// t = T / den, T = 2 v0 * N, den = 2 N * D, N the normal, whose rounding is below 4u times the
// product of lengths `area` that bounds it: t is off by less than
// 16u area (|D| t + v) / |T|, relatively, and by kDepthNoise area (|D| z + v) / |T|.
#if defined(DELRAY_RAYTRACE_TRIANGLE_LANES) == defined(HWY_TARGET_TOGGLE)
#ifdef DELRAY_RAYTRACE_TRIANGLE_LANES
#undef DELRAY_RAYTRACE_TRIANGLE_LANES
#else
#define DELRAY_RAYTRACE_TRIANGLE_LANES
#endif

#include <hwy/highway.h>

#include "raytrace/first_hits/ray_space.h"
#include "shading/lanes.h"

HWY_BEFORE_NAMESPACE();
namespace delray::raytrace {
namespace HWY_NAMESPACE {

using namespace shading::HWY_NAMESPACE;

// See above; twice what is needed.
constexpr float kNoise = 0x1p-19F, kDepthNoise = 0x1p-20F;
// Depths that may be off by more are loose: nothing is concluded from them.
constexpr float kLooseDepth = 0x1p-14F;
// Of |D||e|(|v1| + |v2|), v1 and v2 the ends of the edge: more than its function may be off.
constexpr float kInside = 10 * 0x1p-24F;
// Between these products of lengths neither under- nor overflow, and Embree leaves no corner out.
constexpr float kTiny = 1e-25F, kHuge = 1e12F;

HWY_INLINE F3 exact_cross(const F3& a, const F3& b) {
  return {hn::MulSub(a.y, b.z, a.z * b.y), hn::MulSub(a.z, b.x, a.x * b.z),
          hn::MulSub(a.x, b.y, a.y * b.x)};
}
HWY_INLINE F exact_dot(const F3& a, const F3& b) {
  return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, a.z * b.z));
}
HWY_INLINE F exact_reciprocal(F a) {
  const F r = hn::ApproximateReciprocal(a);
  return hn::MulAdd(r, hn::NegMulAdd(a, r, set(1.0F)), r);
}
HWY_INLINE F exact_normal(F ab, F ab_other, F bc, F bc_other, F ab_first, F bc_first) {
  const F of_ab = hn::MulSub(ab, ab_first, ab_other), of_bc = hn::MulSub(bc, bc_first, bc_other);
  return hn::IfThenElse(hn::Lt(hn::Abs(ab_other), hn::Abs(bc_other)), of_ab, of_bc);
}
// The normal by the two edges whose products are the smaller, component by component.
HWY_INLINE F3 exact_normal(const F3& a, const F3& b, const F3& c) {
  return {exact_normal(a.y, a.z * b.y, b.y, b.z * c.y, b.z, c.z),
          exact_normal(a.z, a.x * b.z, b.z, b.x * c.z, b.x, c.x),
          exact_normal(a.x, a.y * b.x, b.x, b.y * c.x, b.y, c.y)};
}

// Corners seen from the origin of rays, and what follows for any direction.
struct TriangleLanes {
  F3 corner[3], edge[3], normal;
  F edge_length[3], corner_length[3];
  F depth;              // T
  F longest, farthest;  // edge, corner
  F area;               // of the edges that the normal is made of
};

HWY_INLINE F length_of(const F3& v) { return hn::Sqrt(dot(v, v)); }

HWY_INLINE TriangleLanes triangles_of(const F3 position[3], const glm::vec3& origin) {
  TriangleLanes t;
  const F3 from = set(origin);
  for (int k = 0; k < 3; ++k) t.corner[k] = position[k] - from;
  t.edge[0] = t.corner[2] - t.corner[0];
  t.edge[1] = t.corner[0] - t.corner[1];
  t.edge[2] = t.corner[1] - t.corner[2];
  t.normal = exact_normal(t.edge[0], t.edge[1], t.edge[2]);
  const F half = exact_dot(t.corner[0], t.normal);
  t.depth = half + half;
  for (int k = 0; k < 3; ++k) {
    t.edge_length[k] = length_of(t.edge[k]);
    t.corner_length[k] = length_of(t.corner[k]);
  }
  const auto most = [](const F x[3]) { return hn::Max(x[0], hn::Max(x[1], x[2])); };
  t.longest = most(t.edge_length);
  t.farthest = most(t.corner_length);
  t.area = t.edge_length[1] * hn::Min(t.edge_length[0], t.edge_length[2]);
  return t;
}

// Whether depths of hits are good to kLooseDepth, of triangles no deeper than `deepest`.
HWY_INLINE M is_firm(const TriangleLanes& t, const RaySpace& space, F deepest) {
  const F size = t.area * (set(space.longest) * hn::Abs(deepest) + t.farthest);
  const M firm = hn::Ge(hn::Abs(t.depth) * set(kLooseDepth / kDepthNoise), size);
  const M usual = hn::And(hn::Ge(t.longest * t.longest * t.farthest, set(kTiny)),
                          hn::Le(t.farthest, set(kHuge)));
  // Boxes of instances see rays that are off by so much.
  const F off = set(4.0F * space.off_angle) * t.farthest + set(4.0F * space.off_length);
  const M near = hn::Le(off, t.farthest * set(kLooseDepth));
  return hn::And(firm, hn::And(usual, near));
}

// How far beside its place in the world a ray may meet triangles, where that makes a difference:
// inside the box of their instance, by twice as far and more, the ray meets the box all the same.
HWY_INLINE F off_at_box(const F3 position[3], const TriangleLanes& t, const RaySpace& space) {
  const F off = set(space.off_angle) * t.farthest + set(space.off_length);
  const F3 low = set(space.box.low), high = set(space.box.high);
  F clearance = set(1e30F);
  for (int k = 0; k < 3; ++k) {
    const F3 over = position[k] - low, under = high - position[k];
    clearance = hn::Min(clearance, hn::Min(over.x, hn::Min(over.y, over.z)));
    clearance = hn::Min(clearance, hn::Min(under.x, hn::Min(under.y, under.z)));
  }
  return hn::IfThenElse(hn::Gt(clearance, set(4.0F) * off), hn::Zero(FloatTag()), off);
}

// The least magnitude of the function of edge k at a hit that is safely inside: it has the sign of
// the exact one, so that the ray itself meets the triangle, and with it the boxes around it, which
// are tested so that no rounding leaves out a ray that meets them (Ize 2013). `off`: off_at_box.
HWY_INLINE F inside_margin(const TriangleLanes& t, int k, F off, const RaySpace& space) {
  const F ends = t.corner_length[(k + 2) % 3] + t.corner_length[(k + 3) % 3];
  return set(space.longest) * t.edge_length[k] * (set(kInside) * ends + set(4.0F) * off);
}

// The corners of up to sixteen triangles, as floats one after the other.
struct CornerLanes {
  CornerLanes() {}  // thousands a frame: values are left as they are
  union {
    shading::Floats16 value[9];
  };
};
HWY_INLINE void clear_corners(int i, CornerLanes& to) {
  for (shading::Floats16& value : to.value) value[i] = 0.0F;
}
HWY_INLINE void load_corners(const CornerLanes& corners, int i, F3 position[3]) {
  for (int k = 0; k < 3; ++k) {
    position[k] = {load(corners.value[3 * k], i), load(corners.value[3 * k + 1], i),
                   load(corners.value[3 * k + 2], i)};
  }
}
HWY_INLINE void set_corners(const glm::vec3* positions, const glm::uvec3& corners, int i,
                            CornerLanes& to) {
  for (int k = 0; k < 3; ++k) {
    const glm::vec3& p = positions[corners[k]];
    to.value[3 * k][i] = p.x;
    to.value[3 * k + 1][i] = p.y;
    to.value[3 * k + 2][i] = p.z;
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace delray::raytrace
HWY_AFTER_NAMESPACE();

#endif
