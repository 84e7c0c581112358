// The insphere test of one point against four tetrahedra at once, in vector registers (Highway).
//
// Each lane evaluates the rounded determinant of its tetrahedron, first against the error bound of
// the whole mesh and then against one from the extent of its points. The file is compiled for every
// instruction set and the fastest that the machine has is chosen when the program runs. About one
// determinant's arithmetic for four tests where registers hold four doubles.
//
// Degenerate: points on a common sphere are decided by the perturbation of conflict.h where nothing
// is rounded; elsewhere signs that rounding leaves open are reported as undecided.
#include "delaunay/cavity/four_spheres.h"

#include <algorithm>
#include <array>
#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "delaunay/cavity/four_spheres.cpp"
#include <hwy/foreach_target.h>
// After foreach_target, which includes this file once for each instruction set.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace delray::delaunay::internal {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kLanes = HWY_TARGET == HWY_SCALAR                  ? 1
                               : HWY_HAVE_SCALABLE || HWY_MAX_BYTES < 32 ? 2
                                                                         : 4;
using Doubles = hn::CappedTag<double, kLanes>;
using V = hn::Vec<Doubles>;

struct Points {
  V x, y, z;
};

// Corner `corner` of kLanes simplices.
HWY_INLINE Points load_corners(const SpaceVertex* vertices, const Mesh<3>& mesh,
                               const SimplexNumber* simplices, unsigned corner) {
  const Doubles d;
  const auto at = [&](std::size_t lane) {
    return &vertices[mesh.vertex(corner_of(simplices[lane], corner)) + 1U].position.x;
  };
#if HWY_TARGET != HWY_SCALAR && !HWY_HAVE_SCALABLE && HWY_MAX_BYTES >= 32
  // Memory behind a position may be written by another thread.
  const auto three = hn::FirstN(d, 3);
  const V p0 = hn::MaskedLoad(three, d, at(0)), p1 = hn::MaskedLoad(three, d, at(1));
  const V p2 = hn::MaskedLoad(three, d, at(2)), p3 = hn::MaskedLoad(three, d, at(3));
  const V xz01 = hn::InterleaveLower(d, p0, p1), xz23 = hn::InterleaveLower(d, p2, p3);
  const V y01 = hn::InterleaveUpper(d, p0, p1), y23 = hn::InterleaveUpper(d, p2, p3);
  return {hn::ConcatLowerLower(d, xz23, xz01), hn::ConcatLowerLower(d, y23, y01),
          hn::ConcatUpperUpper(d, xz23, xz01)};
#else
  std::array<std::array<double, kLanes>, 3> columns;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    for (std::size_t k = 0; k < 3; ++k) columns[k][lane] = at(lane)[k];
  }
  return {hn::LoadU(d, columns[0].data()), hn::LoadU(d, columns[1].data()),
          hn::LoadU(d, columns[2].data())};
#endif
}

HWY_INLINE Points relative(const Points& p, const Points& q) {
  return {hn::Sub(p.x, q.x), hn::Sub(p.y, q.y), hn::Sub(p.z, q.z)};
}

HWY_INLINE V minor(const Points& p, const Points& q) {
  return hn::Sub(hn::Mul(p.x, q.y), hn::Mul(p.y, q.x));
}

HWY_INLINE V determinant(const Points& p, V qr, const Points& q, V pr, const Points& r, V pq) {
  return hn::Add(hn::Sub(hn::Mul(p.z, qr), hn::Mul(q.z, pr)), hn::Mul(r.z, pq));
}

HWY_INLINE V lift(const Points& p) {
  return hn::Add(hn::Add(hn::Mul(p.x, p.x), hn::Mul(p.y, p.y)), hn::Mul(p.z, p.z));
}

HWY_INLINE V largest_of(V a, V b, V c, V d) {
  return hn::Max(hn::Max(hn::Abs(a), hn::Abs(b)), hn::Max(hn::Abs(c), hn::Abs(d)));
}

template <class Mask>
HWY_INLINE unsigned bits_of(const Mask& mask) {
  std::array<std::uint8_t, 8> bytes = {};  // Highway may write all of them
  hn::StoreMaskBits(Doubles(), mask, bytes.data());
  return bytes[0] & ((1U << kLanes) - 1);
}

HWY_INLINE FourConflicts test_lanes(const SphereTests& tests, const SpaceVertex* vertices,
                                    const Mesh<3>& mesh, const SimplexNumber* simplices,
                                    const glm::dvec3& point) {
  const Doubles tag;
  const Points q = {hn::Set(tag, point.x), hn::Set(tag, point.y), hn::Set(tag, point.z)};
  const Points a = relative(load_corners(vertices, mesh, simplices, 0), q);
  const Points b = relative(load_corners(vertices, mesh, simplices, 1), q);
  const Points c = relative(load_corners(vertices, mesh, simplices, 2), q);
  const Points d = relative(load_corners(vertices, mesh, simplices, 3), q);
  const V ab = minor(a, b), ac = minor(a, c), ad = minor(a, d);
  const V bc = minor(b, c), bd = minor(b, d), cd = minor(c, d);
  const V bcd = determinant(b, cd, c, bd, d, bc), acd = determinant(a, cd, c, ad, d, ac);
  const V abd = determinant(a, bd, b, ad, d, ab), abc = determinant(a, bc, b, ac, c, ab);
  const V sum = hn::Add(hn::Sub(hn::Mul(lift(a), bcd), hn::Mul(lift(b), acd)),
                        hn::Sub(hn::Mul(lift(c), abd), hn::Mul(lift(d), abc)));

  const SphereBounds& bounds = tests.bounds();
  const V error = hn::Set(tag, bounds.insphere_error);
  auto inside = hn::Gt(sum, error);
  const auto small = hn::Not(hn::Gt(hn::Abs(sum), error));  // so that NaN is undecided
  if (hn::AllFalse(tag, small)) return {bits_of(inside), 0};
  if (bounds.ties_are_exact) {
    // cospherical_inside() for all lanes: replacing a corner by q gives one of the determinants
    // above, and coordinates relative to q make one number that is ordered as they are.
    const V shift = hn::Set(tag, SphereBounds::kTieShift), zero = hn::Zero(tag);
    V highest = zero, turn = zero;
    const auto visit = [&](const Points& p, V replaced) {
      const V key = hn::Add(hn::Mul(hn::Add(hn::Mul(p.x, shift), p.y), shift), p.z);
      const auto decides = hn::And(hn::Gt(key, highest), hn::Ne(replaced, zero));
      highest = hn::IfThenElse(decides, key, highest);
      turn = hn::IfThenElse(decides, replaced, turn);
    };
    visit(a, bcd);
    visit(b, hn::Neg(acd));
    visit(c, abd);
    visit(d, hn::Neg(abc));
    inside = hn::Or(inside, hn::And(small, hn::Gt(turn, zero)));
    return {bits_of(inside), 0};
  }
  if (!bounds.has_second_stage) return {bits_of(inside), bits_of(small)};
  const V x = largest_of(a.x, b.x, c.x, d.x), y = largest_of(a.y, b.y, c.y, d.y);
  const V z = largest_of(a.z, b.z, c.z, d.z);
  const V largest = hn::Max(hn::Max(x, y), hn::Max(z, hn::Set(tag, 1.0)));
  const V size = hn::Mul(hn::Mul(hn::Mul(x, y), z),
                         hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z)));
  const V underflow = hn::Mul(hn::Mul(largest, largest), largest);
  const V tight = hn::Add(hn::Mul(hn::Set(tag, SphereBounds::kInsphereError), size),
                          hn::Mul(hn::Set(tag, kUnderflow), underflow));
  inside = hn::Gt(sum, tight);
  const auto too_small = hn::Not(hn::Gt(hn::Abs(sum), tight));
  if (hn::AllFalse(tag, too_small)) return {bits_of(inside), 0};
  return {bits_of(inside), bits_of(too_small)};
}

FourConflicts test_four(const SphereTests& tests, const SpaceVertex* vertices, const Mesh<3>& mesh,
                        const SimplexNumber* simplices, const glm::dvec3& q) {
  FourConflicts all = {0, 0};
  for (unsigned first = 0; first < 4; first += kLanes) {
    const FourConflicts some = test_lanes(tests, vertices, mesh, simplices + first, q);
    all.inside |= some.inside << first;
    all.undecided |= some.undecided << first;
  }
  return all;
}

// A function of each instruction set that gives another one of it: calls through the latter choose
// no more.
TestFourSpheres chosen_test() { return &test_four; }

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace delray::delaunay::internal
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace delray::delaunay::internal {

HWY_EXPORT(chosen_test);

TestFourSpheres test_four_spheres() { return HWY_DYNAMIC_DISPATCH(chosen_test)(); }

}  // namespace delray::delaunay::internal
#endif
