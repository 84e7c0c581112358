// Makes planes of vertex attributes and evaluates them at sixteen pixels at a time, with the
// operations of point_at in their order.
//
// An attribute divided by depth is linear on the screen: a plane's value over that of 1 is the
// attribute (Olano and Greer 1997). Where all lanes show one triangle on one row, planes are not
// gathered.
//
// Degenerate: normals without a direction become those of the triangle; tangents without one count
// as missing.
#include "raster/shading/point_planes.h"

#include <algorithm>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/shading/point_planes.cpp"
#include <hwy/foreach_target.h>
// Highway's own header comes after it.
#include <hwy/highway.h>

#include "raster/shading/plane_lanes.h"

HWY_BEFORE_NAMESPACE();
namespace delray::raster {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = HWY_CAPPED(float, shading::kBlockPoints);
using F = hn::Vec<Floats>;
using M = hn::Mask<Floats>;

struct Vector {
  F x, y, z;
};
HWY_INLINE Vector minus(const Vector& a, const Vector& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE Vector times(const Vector& v, F factor) {
  return {hn::Mul(v.x, factor), hn::Mul(v.y, factor), hn::Mul(v.z, factor)};
}
HWY_INLINE F dot(const Vector& a, const Vector& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
HWY_INLINE Vector cross(const Vector& a, const Vector& b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(b.y, a.z)),
          hn::Sub(hn::Mul(a.z, b.x), hn::Mul(b.z, a.x)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(b.x, a.y))};
}
HWY_INLINE Vector chosen(M mask, const Vector& yes, const Vector& no) {
  return {hn::IfThenElse(mask, yes.x, no.x), hn::IfThenElse(mask, yes.y, no.y),
          hn::IfThenElse(mask, yes.z, no.z)};
}
HWY_INLINE Vector of(const FourVectors<F>& v) { return {v.v[0], v.v[1], v.v[2]}; }

// `otherwise` where v has no direction.
HWY_INLINE Vector unit(const Vector& v, const Vector& otherwise) {
  const Floats d;
  const F squared = dot(v, v);
  const M usable = hn::And(hn::Gt(squared, hn::Zero(d)),
                           hn::Le(squared, hn::Set(d, std::numeric_limits<float>::max())));
  return chosen(usable, times(v, hn::Div(hn::Set(d, 1.0F), hn::Sqrt(squared))), otherwise);
}

HWY_INLINE void store(const Vector& v, shading::Vectors16& to, std::size_t i) {
  const Floats d;
  hn::Store(v.x, d, to.x.lane + i);
  hn::Store(v.y, d, to.y.lane + i);
  hn::Store(v.z, d, to.z.lane + i);
}

void set_up_points(const WorldVertices& vertices, std::size_t vertex_count,
                   const CornerNumbers& corners, std::size_t count, float handedness,
                   const TrianglePlanes& barycentrics, std::size_t first, PointPlanes& planes) {
  const Floats d;
  const std::size_t lanes = hn::Lanes(d);
  const F one = hn::Set(d, 1.0F), zero = hn::Zero(d);
  VertexRows positions, normals;
  for (std::size_t i = 0; i < vertex_count; i += lanes) {
    HWY_ALIGN float has_normal[shading::kBlockPoints];
    for (std::size_t k = 0; k < lanes; ++k) has_normal[k] = vertices.has_normal[i + k];
    store_rows(d,
               FourVectors<F>{{hn::Load(d, vertices.position[0] + i),
                               hn::Load(d, vertices.position[1] + i),
                               hn::Load(d, vertices.position[2] + i), one}},
               [&](std::size_t m) HWY_ATTR { return positions.row[i + m]; });
    store_rows(
        d,
        FourVectors<F>{{hn::Load(d, vertices.normal[0] + i), hn::Load(d, vertices.normal[1] + i),
                        hn::Load(d, vertices.normal[2] + i), hn::Load(d, has_normal)}},
        [&](std::size_t m) HWY_ATTR { return normals.row[i + m]; });
  }
  const Vector up = {zero, zero, one};
  for (std::size_t i = 0; i < count; i += lanes) {
    FourVectors<F> position[3], normal[3];
    for (int k = 0; k < 3; ++k) {
      const std::uint8_t* const which = corners.of[k] + i;
      position[k] = load_rows(d, [&](std::size_t m) HWY_ATTR { return positions.row[which[m]]; });
      normal[k] = load_rows(d, [&](std::size_t m) HWY_ATTR { return normals.row[which[m]]; });
    }
    const Vector p = of(position[0]);
    const Vector across = cross(minus(of(position[1]), p), minus(of(position[2]), p));
    const Vector geometric = unit(times(across, hn::Set(d, handedness)), up);
    for (auto& n : normal) {
      const Vector own = chosen(hn::Ne(n.v[3], zero), of(n), geometric);
      n = {{own.x, own.y, own.z, zero}};
    }
    store_triangles(barycentrics, first + i, position, planes.position.data() + first + i);
    store_planes(barycentrics, first + i, normal, planes.normal.data() + first + i);
    store_rows(d, FourVectors<F>{{geometric.x, geometric.y, geometric.z, zero}},
               [&](std::size_t m) HWY_ATTR { return &planes.geometric[first + i + m].x; });
  }
}

void set_up_values(const VertexRows& vertices, const CornerNumbers& corners, std::size_t count,
                   const TrianglePlanes& barycentrics, std::size_t first, ValuePlanes* planes) {
  const Floats d;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    FourVectors<F> values[3];
    for (int k = 0; k < 3; ++k) {
      values[k] =
          load_rows(d, [&](std::size_t m) HWY_ATTR { return vertices.row[corners.of[k][i + m]]; });
    }
    store_planes(barycentrics, first + i, values, planes + first + i);
  }
}

// Some lanes of a block: the arithmetic of point_at.
class LanePoints {
 public:
  HWY_INLINE LanePoints(const PixelTriangle* triangles, const PixelBlock& block, std::size_t first)
      : which_(block.triangle + first) {
    for (std::size_t i = 0; i < hn::Lanes(Floats()); ++i) {
      const PixelTriangle& t = triangles[which_[i]];
      dx_[i] = block.x[first + i] - t.x;
      dy_[i] = block.y[first + i] - t.y;
      all_same_ &= which_[i] == which_[0] && dy_[i] == dy_[0];
    }
  }

  template <class Planes>
  HWY_INLINE FourVectors<F> sums(const Planes* all) const {
    const Floats d;
#if HWY_TARGET != HWY_SCALAR
    if (!all_same_) {
      const HWY_CAPPED(float, 4) four;
      return transposed_rows(d, [&](std::size_t i) HWY_ATTR {
        const auto& t = all[which_[i]];
        return hn::Add(
            hn::Mul(hn::LoadU(four, t.a), hn::Set(four, dx_[i])),
            hn::Add(hn::Mul(hn::LoadU(four, t.b), hn::Set(four, dy_[i])), hn::LoadU(four, t.c)));
      });
    }
#endif
    const auto& t = all[which_[0]];
    const F dx = hn::Load(d, dx_);
    FourVectors<F> result;
    for (int k = 0; k < 4; ++k)
      result.v[k] = hn::Add(hn::Mul(hn::Set(d, t.a[k]), dx), hn::Set(d, t.b[k] * dy_[0] + t.c[k]));
    return result;
  }
  // What row(triangle) points at, four numbers.
  template <class Row>
  HWY_INLINE FourVectors<F> rows(const Row& row) const {
    return load_rows(Floats(), [&](std::size_t i) HWY_ATTR { return row(which_[i]); });
  }

 private:
  const std::uint16_t* which_;
  HWY_ALIGN float dx_[shading::kBlockPoints], dy_[shading::kBlockPoints];
  bool all_same_ = true;
};

// The arithmetic of texture_point, for sets from 0 on.
HWY_INLINE void set_texture_points(const LanePoints& lanes, const UvPlanes& uv_planes,
                                   const PixelTriangle* ones, F share, std::size_t to,
                                   shading::Points& points) {
  const ValuePlanes* const uvs = uv_planes.planes.data();
  const Floats d;
  const FourVectors<F> uv = lanes.sums(uvs);
  const auto change = [&](F slope, F value, F slope_of_one) HWY_ATTR {
    return hn::Mul(hn::Sub(slope, hn::Mul(value, slope_of_one)), share);
  };
  const FourVectors<F> a = lanes.rows([&](std::uint16_t t) HWY_ATTR { return uvs[t].a; });
  const FourVectors<F> b = lanes.rows([&](std::uint16_t t) HWY_ATTR { return uvs[t].b; });
  const F a1 = lanes.rows([&](std::uint16_t t) HWY_ATTR { return ones[t].a; }).v[3];
  const F b1 = lanes.rows([&](std::uint16_t t) HWY_ATTR { return ones[t].b; }).v[3];
  const auto store_set = [&](int set) HWY_ATTR {
    shading::TexturePoints& result = points.uvs[set];
    const int k = 2 * set;
    const F u = hn::Mul(uv.v[k], share), v = hn::Mul(uv.v[k + 1], share);
    hn::Store(u, d, result.u.lane + to);
    hn::Store(v, d, result.v.lane + to);
    hn::Store(change(a.v[k], u, a1), d, result.dx_u.lane + to);
    hn::Store(change(a.v[k + 1], v, a1), d, result.dx_v.lane + to);
    hn::Store(change(b.v[k], u, b1), d, result.dy_u.lane + to);
    hn::Store(change(b.v[k + 1], v, b1), d, result.dy_v.lane + to);
  };
  store_set(0);
  if (uv_planes.sets > 1) store_set(1);
}

HWY_INLINE void set_some(const PointPlanes& planes, const PixelBlock& block, std::size_t to,
                         shading::Points& points) {
  const Floats d;
  const LanePoints lanes(planes.position.data(), block, to);
  const FourVectors<F> position = lanes.sums(planes.position.data());
  const F share = hn::Div(hn::Set(d, 1.0F), position.v[3]);
  store(times(of(position), share), points.position, to);
  const FourVectors<F> geometric =
      lanes.rows([&](std::uint16_t t) HWY_ATTR { return &planes.geometric[t].x; });
  store(of(geometric), points.geometric_normal, to);
  const Vector normal = unit(times(of(lanes.sums(planes.normal.data())), share), of(geometric));
  store(normal, points.normal, to);
  if (!planes.colour.empty()) {
    const FourVectors<F> colour = lanes.sums(planes.colour.data());
    store(times(of(colour), share), points.colour, to);
    hn::Store(hn::Mul(colour.v[3], share), d, points.colour_alpha.lane + to);
  }
  if (!planes.uv.empty()) {
    set_texture_points(lanes, {planes.uv, planes.texture_sets}, planes.position.data(), share, to,
                       points);
  }
  if (!planes.tangent.empty()) {
    const Vector tangent = times(of(lanes.sums(planes.tangent.data())), share);
    const Vector nothing = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    const Vector along = unit(minus(tangent, times(normal, dot(normal, tangent))), nothing);
    store(along, points.tangent, to);
    const M none = hn::And(hn::And(hn::Eq(along.x, nothing.x), hn::Eq(along.y, nothing.x)),
                           hn::Eq(along.z, nothing.x));
    hn::Store(hn::IfThenZeroElse(none, geometric.v[3]), d, points.handedness.lane + to);
  }
}

void set_points(const PointPlanes& planes, const PixelBlock& block, shading::Points& points) {
  for (std::size_t i = 0; i < shading::kBlockPoints; i += hn::Lanes(Floats()))
    set_some(planes, block, i, points);
}

void set_values(const PixelTriangle* values, const UvPlanes& uvs, const PixelBlock& block,
                shading::Vectors16& results, shading::Points& points) {
  const Floats d;
  for (std::size_t i = 0; i < shading::kBlockPoints; i += hn::Lanes(d)) {
    const LanePoints lanes(values, block, i);
    const FourVectors<F> sums = lanes.sums(values);
    const F share = hn::Div(hn::Set(d, 1.0F), sums.v[3]);
    store(times(of(sums), share), results, i);
    if (!uvs.planes.empty()) set_texture_points(lanes, uvs, values, share, i, points);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace delray::raster
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace delray::raster {

HWY_EXPORT(set_up_points);
HWY_EXPORT(set_up_values);
HWY_EXPORT(set_points);
HWY_EXPORT(set_values);

void set_up_points(const WorldVertices& vertices, std::size_t vertex_count,
                   const CornerNumbers& corners, std::size_t count, float handedness,
                   const TrianglePlanes& barycentrics, std::size_t first, PointPlanes& planes) {
  HWY_DYNAMIC_DISPATCH(set_up_points)
  (vertices, vertex_count, corners, count, handedness, barycentrics, first, planes);
}
void set_up_values(const VertexRows& vertices, const CornerNumbers& corners, std::size_t count,
                   const TrianglePlanes& barycentrics, std::size_t first, ValuePlanes* planes) {
  HWY_DYNAMIC_DISPATCH(set_up_values)(vertices, corners, count, barycentrics, first, planes);
}
void set_points(const PointPlanes& planes, const PixelBlock& block, shading::Points& points) {
  HWY_DYNAMIC_DISPATCH(set_points)(planes, block, points);
}

void set_values(std::span<const PixelTriangle> values, const UvPlanes& uvs, const PixelBlock& block,
                shading::Vectors16& results, shading::Points& points) {
  HWY_DYNAMIC_DISPATCH(set_values)(values.data(), uvs, block, results, points);
}

}  // namespace delray::raster
#endif
