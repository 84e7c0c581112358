#include "raster/internal/transform.h"

#include <algorithm>
#include <cstring>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/transform.cpp"
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

V transformed(Floats d, const glm::vec4& row, V x, V y, V z) {
  const V xy = hn::Add(hn::Mul(hn::Set(d, row.x), x), hn::Mul(hn::Set(d, row.y), y));
  return hn::Add(hn::Add(xy, hn::Mul(hn::Set(d, row.z), z)), hn::Set(d, row.w));
}

// One vector of vertices; reads and writes 3 * Lanes(Floats) values.
void transform_vector(const ToView& to_view, const Screen& screen, const float* HWY_RESTRICT in,
                      float* HWY_RESTRICT out) {
  const Floats d;
  const Ints di;
  V x, y, z;
  hn::LoadInterleaved3(d, in, x, y, z);
  const V view_x = transformed(d, to_view.row[0], x, y, z);
  const V view_y = transformed(d, to_view.row[1], x, y, z);
  const V view_z = transformed(d, to_view.row[2], x, y, z);

  const V scale = hn::Set(d, screen.view.scale);
  const V subpixels = hn::Set(d, static_cast<float>(kSubpixels));
  const V right = hn::Mul(hn::Mul(hn::Div(view_x, view_z), scale), subpixels);
  const V up = hn::Mul(hn::Mul(hn::Div(view_y, view_z), scale), subpixels);
  const V screen_x = hn::Add(hn::Set(d, screen.offset_x), right);
  const V screen_y = hn::Sub(hn::Set(d, screen.offset_y), up);
  const V depth = hn::Min(hn::Div(hn::Set(d, -screen.view.near), view_z), hn::Set(d, kDeepest));

  // Comparisons with NaN are false: what is not a number is outside.
  const V guard = hn::Set(d, static_cast<float>(kGuardSubpixels));
  const auto inside =
      hn::And(hn::And(hn::Ge(view_z, hn::Set(d, screen.view.near)),
                      hn::Lt(view_z, hn::Set(d, std::numeric_limits<float>::max()))),
              hn::And(hn::Le(hn::Abs(screen_x), guard), hn::Le(hn::Abs(screen_y), guard)));
  const auto fixed_x =
      hn::IfThenElse(hn::RebindMask(di, inside), hn::NearestInt(screen_x), hn::Set(di, kOutside));
  hn::StoreInterleaved3(hn::BitCast(d, fixed_x), hn::BitCast(d, hn::NearestInt(screen_y)), depth, d,
                        out);
}

void transform(const ToView& to_view, const Screen& screen, const float* in, float* out,
               std::size_t vertices) {
  const std::size_t lanes = hn::Lanes(Floats());
  std::size_t i = 0;
  for (; i + lanes <= vertices; i += lanes)
    transform_vector(to_view, screen, in + 3 * i, out + 3 * i);
  if (i == vertices) return;
  HWY_ALIGN float rest_in[3 * 16] = {};
  HWY_ALIGN float rest_out[3 * 16];
  std::copy(in + 3 * i, in + 3 * vertices, rest_in);
  transform_vector(to_view, screen, rest_in, rest_out);
  // As bytes: the integers among them need not be valid floats.
  std::memcpy(out + 3 * i, rest_out, 3 * (vertices - i) * sizeof(float));
}

}  // namespace HWY_NAMESPACE
}  // namespace delray::raster
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace delray::raster {

HWY_EXPORT(transform);

ToView to_view(const scenes::View& view, const glm::mat4x3& transform) {
  const glm::dvec3 axes[3] = {view.right, view.up, view.forward};
  const glm::dmat4x3 to_world(transform);
  ToView result;
  for (int k = 0; k < 3; ++k)
    result.row[k] = glm::vec4(glm::dot(axes[k], to_world[0]), glm::dot(axes[k], to_world[1]),
                              glm::dot(axes[k], to_world[2]),
                              glm::dot(axes[k], to_world[3] - glm::dvec3(view.eye)));
  return result;
}

void transform(const ToView& to_view, const Screen& screen, std::span<const glm::vec3> positions,
               std::span<ScreenVertex> vertices) {
  static_assert(sizeof(glm::vec3) == 3 * sizeof(float) &&
                sizeof(ScreenVertex) == 3 * sizeof(float));
  HWY_DYNAMIC_DISPATCH(transform)
  (to_view, screen, reinterpret_cast<const float*>(positions.data()),
   reinterpret_cast<float*>(vertices.data()), positions.size());
}

}  // namespace delray::raster
#endif
