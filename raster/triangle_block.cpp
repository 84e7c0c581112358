#include "raster/internal/triangle_block.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/triangle_block.cpp"
#include <hwy/foreach_target.h>
// Highway's own header comes after it.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace delray::raster {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = HWY_CAPPED(float, kBlockSize);
using Doubles = HWY_CAPPED(double, kBlockSize / 2);
using DoubleFloats = hn::Rebind<float, Doubles>;
using DoubleInts = hn::Rebind<std::int32_t, Doubles>;
using F = hn::Vec<Floats>;
using D = hn::Vec<Doubles>;

template <class V>
struct Vector {
  V x, y, z;
};
template <class V>
HWY_INLINE Vector<V> operator-(const Vector<V>& a, const Vector<V>& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
template <class V>
HWY_INLINE Vector<V> scaled(const Vector<V>& a, V factor) {
  return {hn::Mul(a.x, factor), hn::Mul(a.y, factor), hn::Mul(a.z, factor)};
}
template <class V>
HWY_INLINE V dot(const Vector<V>& a, const Vector<V>& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
template <class V>
HWY_INLINE Vector<V> cross(const Vector<V>& a, const Vector<V>& b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(b.y, a.z)),
          hn::Sub(hn::Mul(a.z, b.x), hn::Mul(b.z, a.x)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(b.x, a.y))};
}

HWY_INLINE Vector<F> load(const float (&from)[3][kBlockSize], std::size_t i) {
  const Floats d;
  return {hn::Load(d, from[0] + i), hn::Load(d, from[1] + i), hn::Load(d, from[2] + i)};
}
HWY_INLINE void store(const Vector<F>& v, float (&to)[3][kBlockSize], std::size_t i) {
  const Floats d;
  hn::Store(v.x, d, to[0] + i);
  hn::Store(v.y, d, to[1] + i);
  hn::Store(v.z, d, to[2] + i);
}
template <class V>
HWY_INLINE Vector<V> select(hn::Mask<hn::DFromV<V>> mask, const Vector<V>& yes,
                            const Vector<V>& no) {
  return {hn::IfThenElse(mask, yes.x, no.x), hn::IfThenElse(mask, yes.y, no.y),
          hn::IfThenElse(mask, yes.z, no.z)};
}

// `usable`: where v has a direction.
HWY_INLINE Vector<F> unit(const Vector<F>& v, const Vector<F>& otherwise,
                          hn::Mask<Floats>& usable) {
  const Floats d;
  const F squared = dot(v, v);
  usable = hn::And(hn::Gt(squared, hn::Zero(d)),
                   hn::Le(squared, hn::Set(d, std::numeric_limits<float>::max())));
  const F factor = hn::Div(hn::Set(d, 1.0F), hn::Sqrt(squared));
  return select(usable, scaled(v, factor), otherwise);
}

HWY_INLINE std::uint32_t bits(hn::Mask<Floats> mask, std::size_t first) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(Floats(), mask, bytes);
  return (bytes[0] | static_cast<std::uint32_t>(bytes[1]) << 8) << first;
}

HWY_INLINE void attributes(const Screen& screen, const TriangleBlock& block, std::size_t i,
                           TriangleGeometry& geometry) {
  const Floats d;
  const Vector<F> columns[4] = {load(block.to_world[0], i), load(block.to_world[1], i),
                                load(block.to_world[2], i), load(block.to_world[3], i)};
  Vector<F> position[3];
  for (int k = 0; k < 3; ++k) {
    const Vector<F> p = load(block.position[k], i);
    const auto component = [&](F m0, F m1, F m2, F m3) {
      return hn::Add(hn::Add(hn::Add(hn::Mul(m0, p.x), hn::Mul(m1, p.y)), hn::Mul(m2, p.z)), m3);
    };
    position[k] = {component(columns[0].x, columns[1].x, columns[2].x, columns[3].x),
                   component(columns[0].y, columns[1].y, columns[2].y, columns[3].y),
                   component(columns[0].z, columns[1].z, columns[2].z, columns[3].z)};
    store(position[k], geometry.position[k], i);
  }
  hn::Mask<Floats> usable;
  const Vector<F> up{hn::Zero(d), hn::Zero(d), hn::Set(d, 1.0F)};
  const Vector<F> geometric =
      unit(scaled(cross(position[1] - position[0], position[2] - position[0]),
                  hn::Load(d, block.handedness + i)),
           up, usable);
  store(geometric, geometry.geometric_normal, i);

  const Vector<F> rows[3] = {load(block.normal_to_world[0], i), load(block.normal_to_world[1], i),
                             load(block.normal_to_world[2], i)};
  const glm::vec3& eye = screen.view.eye;
  const glm::vec3 backwards = -screen.view.forward;
  const Vector<F> eyes{hn::Set(d, eye.x), hn::Set(d, eye.y), hn::Set(d, eye.z)};
  const Vector<F> otherwise{hn::Set(d, backwards.x), hn::Set(d, backwards.y),
                            hn::Set(d, backwards.z)};
  for (int k = 0; k < 3; ++k) {
    const Vector<F> n = load(block.normal[k], i);
    const auto component = [&](F m0, F m1, F m2) {
      return hn::Add(hn::Add(hn::Mul(m0, n.x), hn::Mul(m1, n.y)), hn::Mul(m2, n.z));
    };
    const Vector<F> normal = unit(
        {component(rows[0].x, rows[1].x, rows[2].x), component(rows[0].y, rows[1].y, rows[2].y),
         component(rows[0].z, rows[1].z, rows[2].z)},
        geometric, usable);
    store(normal, geometry.normal[k], i);
    const Vector<F> way = eyes - position[k];
    const F squared = dot(way, way);
    const F factor = hn::Div(hn::Set(d, 1.0F), hn::Sqrt(squared));
    const Vector<F> view = select(hn::Gt(squared, hn::Zero(d)), scaled(way, factor), otherwise);
    geometry.own_normal[k] |= bits(usable, i);
    geometry.front[k] |= bits(hn::Ge(dot(geometric, view), hn::Zero(d)), i);
    geometry.agree[k] |= bits(hn::Ge(dot(normal, geometric), hn::Zero(d)), i);
  }
}

HWY_INLINE void view_positions(const TriangleBlock& block, std::size_t i,
                               float (&view)[3][3][kBlockSize]) {
  const Floats d;
  for (int k = 0; k < 3; ++k) {
    const Vector<F> p = load(block.position[k], i);
    for (int row = 0; row < 3; ++row) {
      const auto& m = block.to_view[row];
      const F xy =
          hn::Add(hn::Mul(hn::Load(d, m[0] + i), p.x), hn::Mul(hn::Load(d, m[1] + i), p.y));
      hn::Store(hn::Add(hn::Add(xy, hn::Mul(hn::Load(d, m[2] + i), p.z)), hn::Load(d, m[3] + i)), d,
                view[k][row] + i);
    }
  }
}

// std::min and std::max, of which the first argument is kept where one is not a number.
HWY_INLINE D least(D a, D b) { return hn::IfThenElse(hn::Lt(b, a), b, a); }
HWY_INLINE D most(D a, D b) { return hn::IfThenElse(hn::Lt(a, b), b, a); }

HWY_INLINE void barycentrics(const Screen& screen, const float (&view_position)[3][3][kBlockSize],
                             std::size_t i, TriangleGeometry& geometry) {
  const Doubles d;
  const DoubleFloats df;
  const DoubleInts di;
  const scenes::View& view = screen.view;
  const auto set = [&](double value) { return hn::Set(d, value); };
  const D zero = hn::Zero(d);
  const D scale = set(view.scale), half_width = set(view.half_width),
          half_height = set(view.half_height);
  const D width = set(screen.width), height = set(screen.height);

  Vector<D> v[3];
  D low_x = width, high_x = zero, low_y = height, high_y = zero;
  for (int k = 0; k < 3; ++k) {
    v[k] = {hn::PromoteTo(d, hn::Load(df, view_position[k][0] + i)),
            hn::PromoteTo(d, hn::Load(df, view_position[k][1] + i)),
            hn::PromoteTo(d, hn::Load(df, view_position[k][2] + i))};
    const auto in_front = hn::Ge(v[k].z, set(view.near));
    const D x = hn::Add(hn::Mul(hn::Div(v[k].x, v[k].z), scale), half_width);
    const D y = hn::Sub(half_height, hn::Mul(hn::Div(v[k].y, v[k].z), scale));
    low_x = hn::IfThenElseZero(in_front, least(low_x, x));
    high_x = hn::IfThenElse(in_front, most(high_x, x), width);
    low_y = hn::IfThenElseZero(in_front, least(low_y, y));
    high_y = hn::IfThenElse(in_front, most(high_y, y), height);
  }
  const auto amid = [&](D low, D high, D size) {
    const D centre = hn::Mul(hn::Add(most(low, zero), least(high, size)), set(0.5));
    const D last = hn::Sub(size, set(1.0));
    return hn::DemoteTo(di, hn::IfThenElse(hn::Lt(centre, zero), zero, least(centre, last)));
  };
  const auto origin_x = amid(low_x, high_x, width);
  const auto origin_y = amid(low_y, high_y, height);
  hn::Store(origin_x, di, geometry.x + i);
  hn::Store(origin_y, di, geometry.y + i);

  const D ray_x =
      hn::Div(hn::Sub(hn::Add(hn::PromoteTo(d, origin_x), set(0.5)), half_width), scale);
  const D ray_y =
      hn::Div(hn::Sub(half_height, hn::Add(hn::PromoteTo(d, origin_y), set(0.5))), scale);
  const D step = set(1.0 / view.scale);
  const D volume = dot(v[0], cross(v[1] - v[0], v[2] - v[0]));
  const D facing = hn::IfThenElse(hn::Lt(volume, zero), set(-1.0), set(1.0));
  D plane[3][3], largest = zero;
  for (int k = 0; k < 3; ++k) {
    const Vector<D>& p = v[(k + 1) % 3];
    const Vector<D> normal = scaled(cross(p, v[(k + 2) % 3] - p), facing);
    plane[k][0] = hn::Mul(normal.x, step);
    plane[k][1] = hn::Mul(hn::Neg(normal.y), step);
    plane[k][2] = hn::Add(hn::Add(hn::Mul(normal.x, ray_x), hn::Mul(normal.y, ray_y)), normal.z);
    for (const D& coefficient : plane[k]) largest = most(largest, hn::Abs(coefficient));
  }
  const D unit_scale = hn::IfThenElseZero(hn::Gt(largest, zero), hn::Div(set(1.0), largest));
  for (int k = 0; k < 3; ++k) {
    hn::Store(hn::DemoteTo(df, hn::Mul(plane[k][0], unit_scale)), df, geometry.a[k] + i);
    hn::Store(hn::DemoteTo(df, hn::Mul(plane[k][1], unit_scale)), df, geometry.b[k] + i);
    hn::Store(hn::DemoteTo(df, hn::Mul(plane[k][2], unit_scale)), df, geometry.c[k] + i);
  }
}

void compute_geometry(const Screen& screen, const TriangleBlock& block,
                      TriangleGeometry& geometry) {
  HWY_ALIGN float view[3][3][kBlockSize];
  for (int k = 0; k < 3; ++k) geometry.front[k] = geometry.agree[k] = geometry.own_normal[k] = 0;
  for (std::size_t i = 0; i < kBlockSize; i += hn::Lanes(Floats())) {
    attributes(screen, block, i, geometry);
    view_positions(block, i, view);
  }
  for (std::size_t i = 0; i < kBlockSize; i += hn::Lanes(Doubles()))
    barycentrics(screen, view, i, geometry);
}

}  // namespace HWY_NAMESPACE
}  // namespace delray::raster
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace delray::raster {

HWY_EXPORT(compute_geometry);

void TriangleBlock::set_draw(int i, const Draw& draw, const ShadedDraw& shaded) {
  for (int k = 0; k < 3; ++k)
    for (int n = 0; n < 4; ++n) to_view[k][n][i] = shaded.to_view.row[k][n];
  for (int k = 0; k < 4; ++k)
    for (int n = 0; n < 3; ++n) to_world[k][n][i] = (*draw.transform)[k][n];
  for (int k = 0; k < 3; ++k)
    for (int n = 0; n < 3; ++n) normal_to_world[k][n][i] = shaded.normal_to_world[k][n];
  handedness[i] = shaded.handedness;
}

void TriangleBlock::set_triangle(int i, const scenes::Mesh& mesh, const glm::uvec3& corners) {
  for (int k = 0; k < 3; ++k) {
    const glm::vec3& p = mesh.positions[corners[k]];
    position[k][0][i] = p.x;
    position[k][1][i] = p.y;
    position[k][2][i] = p.z;
    if (mesh.normals.empty()) continue;
    const glm::vec3& n = mesh.normals[corners[k]];
    normal[k][0][i] = n.x;
    normal[k][1][i] = n.y;
    normal[k][2][i] = n.z;
  }
}

void compute_geometry(const Screen& screen, const TriangleBlock& block,
                      TriangleGeometry& geometry) {
  HWY_DYNAMIC_DISPATCH(compute_geometry)(screen, block, geometry);
}

}  // namespace delray::raster
#endif
