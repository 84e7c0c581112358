// Transforms, projects and snaps the vertices of a cluster by vectors. The operations and their
// order are the same in scalars and on every instruction set, so that a vertex has one position.
//
// Degenerate: what is not a number, before the near plane or beyond the guard band is marked as
// outside, for clipping.
#include "raster/pipeline/transform.h"

#include <algorithm>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/pipeline/transform.cpp"
#include <hwy/foreach_target.h>
// Highway's own header comes after it.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace delray::raster {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = HWY_CAPPED(float, 16);
using Ints = hn::RebindToSigned<Floats>;
using V = hn::Vec<Floats>;

HWY_INLINE V transformed(Floats d, const glm::vec4& row, V x, V y, V z) {
  const V xy = hn::Add(hn::Mul(hn::Set(d, row.x), x), hn::Mul(hn::Set(d, row.y), y));
  return hn::Add(hn::Add(xy, hn::Mul(hn::Set(d, row.z), z)), hn::Set(d, row.w));
}

// load(i, p) loads the coordinates of the vertices from i on into rows of p.
template <class Load>
HWY_INLINE void transform_all(const ToView& to_view, const Screen& screen, std::size_t count,
                              ScreenVertices& vertices, Load&& load) {
  const Floats d;
  const Ints di;
  const std::size_t lanes = hn::Lanes(d);
  const V scale = hn::Set(d, screen.view.scale);
  const V subpixels = hn::Set(d, static_cast<float>(kSubpixels));
  const V guard = hn::Set(d, static_cast<float>(kGuardSubpixels));
  const bool orthographic = screen.view.orthographic;
  const float range = screen.view.far - screen.view.near;
  auto low_x = hn::Set(di, INT32_MAX), high_x = hn::Set(di, INT32_MIN);
  auto low_y = low_x, high_y = high_x;
  V farthest = hn::Set(d, -std::numeric_limits<float>::infinity());
  bool all_inside = true;
  HWY_ALIGN float p[3][16];
  for (std::size_t i = 0; i < count; i += lanes) {
    load(i, p);
    const V x = hn::Load(d, p[0]), y = hn::Load(d, p[1]), z = hn::Load(d, p[2]);
    const V view_x = transformed(d, to_view.row[0], x, y, z);
    const V view_y = transformed(d, to_view.row[1], x, y, z);
    const V view_z = transformed(d, to_view.row[2], x, y, z);

    const V w = orthographic ? hn::Set(d, 1.0F) : view_z;
    const V right = hn::Mul(hn::Mul(hn::Div(view_x, w), scale), subpixels);
    const V up = hn::Mul(hn::Mul(hn::Div(view_y, w), scale), subpixels);
    const V screen_x = hn::Add(hn::Set(d, screen.offset_x), right);
    const V screen_y = hn::Sub(hn::Set(d, screen.offset_y), up);
    const V of_near = orthographic
                          ? hn::Div(hn::Sub(view_z, hn::Set(d, screen.view.far)), hn::Set(d, range))
                          : hn::Div(hn::Set(d, -screen.view.near), view_z);
    const V depth = hn::Min(of_near, hn::Set(d, kDeepest));

    // Comparisons with NaN are false: what is not a number is outside.
    const auto inside =
        hn::And(hn::And(hn::Ge(view_z, hn::Set(d, screen.view.near)),
                        hn::Lt(view_z, hn::Set(d, std::numeric_limits<float>::max()))),
                hn::And(hn::Le(hn::Abs(screen_x), guard), hn::Le(hn::Abs(screen_y), guard)));
    all_inside &= hn::AllTrue(d, inside);
    const auto fixed_x =
        hn::IfThenElse(hn::RebindMask(di, inside), hn::NearestInt(screen_x), hn::Set(di, kOutside));
    const auto fixed_y = hn::NearestInt(screen_y);
    farthest = hn::Max(farthest, depth);
    low_x = hn::Min(low_x, fixed_x);
    high_x = hn::Max(high_x, fixed_x);
    low_y = hn::Min(low_y, fixed_y);
    high_y = hn::Max(high_y, fixed_y);
    hn::Store(fixed_x, di, vertices.x + i);
    hn::Store(fixed_y, di, vertices.y + i);
    hn::Store(depth, d, vertices.depth + i);
  }
  vertices.any_outside = !all_inside;
  vertices.farthest = hn::GetLane(hn::MaxOfLanes(d, farthest));
  vertices.low_x = hn::GetLane(hn::MinOfLanes(di, low_x));
  vertices.high_x = hn::GetLane(hn::MaxOfLanes(di, high_x));
  vertices.low_y = hn::GetLane(hn::MinOfLanes(di, low_y));
  vertices.high_y = hn::GetLane(hn::MaxOfLanes(di, high_y));
}

// Vector from i on of `count` vertices. The last one repeats its last vertex, which leaves the
// bounds as they are.
template <class At>
HWY_INLINE void load_each(std::size_t i, std::size_t count, At&& at, float (*p)[16]) {
  for (std::size_t k = 0; k < hn::Lanes(Floats()); ++k) {
    const glm::vec3& position = at(std::min(i + k, count - 1));
    p[0][k] = position.x;
    p[1][k] = position.y;
    p[2][k] = position.z;
  }
}

void transform_chosen(const ToView& to_view, const Screen& screen, const glm::vec3* positions,
                      const std::uint32_t* which, std::size_t count, ScreenVertices& vertices) {
  transform_all(to_view, screen, count, vertices, [&](std::size_t i, float(*p)[16]) HWY_ATTR {
    load_each(
        i, count, [&](std::size_t k) -> const glm::vec3& { return positions[which[k]]; }, p);
  });
}

void transform_row(const ToView& to_view, const Screen& screen, const glm::vec3* positions,
                   std::size_t count, ScreenVertices& vertices) {
  const Floats d;
  transform_all(to_view, screen, count, vertices, [&](std::size_t i, float(*p)[16]) HWY_ATTR {
    if (i + hn::Lanes(d) > count) {
      load_each(
          i, count, [&](std::size_t k) -> const glm::vec3& { return positions[k]; }, p);
      return;
    }
    V x, y, z;
    hn::LoadInterleaved3(d, &positions[i].x, x, y, z);
    hn::Store(x, d, p[0]);
    hn::Store(y, d, p[1]);
    hn::Store(z, d, p[2]);
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace delray::raster
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace delray::raster {

HWY_EXPORT(transform_chosen);
HWY_EXPORT(transform_row);

ToView to_view(const scenes::View& view, const glm::mat4x3& transform) {
  const glm::dvec3 axes[3] = {view.right, view.up, view.forward};
  const glm::dmat4x3 to_world(transform);
  ToView result;
  for (int k = 0; k < 3; ++k) {
    result.row[k] = glm::vec4(glm::dot(axes[k], to_world[0]), glm::dot(axes[k], to_world[1]),
                              glm::dot(axes[k], to_world[2]),
                              glm::dot(axes[k], to_world[3] - glm::dvec3(view.eye)));
  }
  return result;
}

void transform(const ToView& to_view, const Screen& screen, std::span<const glm::vec3> positions,
               std::span<const std::uint32_t> which, ScreenVertices& vertices) {
  HWY_DYNAMIC_DISPATCH(transform_chosen)
  (to_view, screen, positions.data(), which.data(), which.size(), vertices);
}

void transform(const ToView& to_view, const Screen& screen, std::span<const glm::vec3> positions,
               ScreenVertices& vertices) {
  HWY_DYNAMIC_DISPATCH(transform_row)
  (to_view, screen, positions.data(), positions.size(), vertices);
}

}  // namespace delray::raster
#endif
