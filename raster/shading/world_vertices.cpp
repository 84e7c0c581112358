// Brings positions and normals of a cluster's vertices into the world by vectors. Degenerate: a
// normal without a direction is marked, and becomes (0, 0, 1).
#include "raster/shading/world_vertices.h"

#include <algorithm>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/shading/world_vertices.cpp"
#include <hwy/foreach_target.h>
// Highway's own header comes after it.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace delray::raster {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = HWY_CAPPED(float, 16);
using Ints = hn::RebindToSigned<Floats>;
using F = hn::Vec<Floats>;

struct Vector {
  F x, y, z;
};

HWY_INLINE Vector load(const float (&from)[3][16]) {
  const Floats d;
  return {hn::Load(d, from[0]), hn::Load(d, from[1]), hn::Load(d, from[2])};
}
HWY_INLINE F product(float x, float y, float z, const Vector& v) {
  const Floats d;
  return hn::Add(hn::Add(hn::Mul(hn::Set(d, x), v.x), hn::Mul(hn::Set(d, y), v.y)),
                 hn::Mul(hn::Set(d, z), v.z));
}

void to_world(const glm::mat4x3& m, const glm::mat3& n, const glm::vec3* positions,
              const glm::vec3* normals, const std::uint32_t* which, std::size_t count,
              WorldVertices& vertices) {
  const Floats d;
  const std::size_t lanes = hn::Lanes(d);
  HWY_ALIGN float p[3][16];
  HWY_ALIGN float q[3][16];
  for (std::size_t i = 0; i < count; i += lanes) {
    for (std::size_t k = 0; k < lanes; ++k) {
      const std::uint32_t vertex = which[std::min(i + k, count - 1)];
      const glm::vec3& position = positions[vertex];
      p[0][k] = position.x;
      p[1][k] = position.y;
      p[2][k] = position.z;
      const glm::vec3 normal = normals == nullptr ? glm::vec3(0.0F) : normals[vertex];
      q[0][k] = normal.x;
      q[1][k] = normal.y;
      q[2][k] = normal.z;
    }
    const Vector position = load(p);
    for (int k = 0; k < 3; ++k) {
      hn::Store(hn::Add(product(m[0][k], m[1][k], m[2][k], position), hn::Set(d, m[3][k])), d,
                vertices.position[k] + i);
    }

    const Vector normal = load(q);
    const F x = product(n[0][0], n[1][0], n[2][0], normal);
    const F y = product(n[0][1], n[1][1], n[2][1], normal);
    const F z = product(n[0][2], n[1][2], n[2][2], normal);
    const F squared = hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z));
    const auto usable = hn::And(hn::Gt(squared, hn::Zero(d)),
                                hn::Le(squared, hn::Set(d, std::numeric_limits<float>::max())));
    const F one = hn::Set(d, 1.0F);
    const F factor = hn::Div(one, hn::Sqrt(squared));
    hn::Store(hn::IfThenElseZero(usable, hn::Mul(x, factor)), d, vertices.normal[0] + i);
    hn::Store(hn::IfThenElseZero(usable, hn::Mul(y, factor)), d, vertices.normal[1] + i);
    hn::Store(hn::IfThenElse(usable, hn::Mul(z, factor), one), d, vertices.normal[2] + i);
    const Ints di;
    const hn::Rebind<std::uint8_t, Ints> d8;
    hn::StoreU(hn::DemoteTo(d8, hn::IfThenElseZero(hn::RebindMask(di, usable), hn::Set(di, 1))), d8,
               vertices.has_normal + i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace delray::raster
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace delray::raster {

HWY_EXPORT(to_world);

void to_world(const Draw& draw, const ShadedDraw& shaded, std::span<const std::uint32_t> which,
              WorldVertices& vertices) {
  HWY_DYNAMIC_DISPATCH(to_world)
  (*draw.transform, shaded.normal_to_world, draw.mesh->positions.data(),
   draw.mesh->normals.empty() ? nullptr : draw.mesh->normals.data(), which.data(), which.size(),
   vertices);
}

}  // namespace delray::raster
#endif
