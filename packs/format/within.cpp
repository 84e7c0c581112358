// Compares coordinates as they lie in memory, three vectors of them at a time, with bounds that
// take turns in the same way.
#include "packs/format/within.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "packs/format/within.cpp"
#include <hwy/foreach_target.h>
// Highway's own header comes after it.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace delray::packs::internal {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Returns how many of the values, from the first on, it has looked at.
std::size_t look_at_most(const geometry::Box3& box, const float* values, std::size_t count,
                         bool& all_within) {
  const HWY_CAPPED(float, 16) d;
  const std::size_t lanes = hn::Lanes(d);
  HWY_ALIGN float low[3 * 16], high[3 * 16];
  for (std::size_t i = 0; i < 3 * lanes; ++i) {
    low[i] = box.low[static_cast<int>(i % 3)];
    high[i] = box.high[static_cast<int>(i % 3)];
  }
  const auto in = [&](std::size_t i, std::size_t k) HWY_ATTR {
    const auto v = hn::LoadU(d, values + i + k * lanes);
    return hn::And(hn::Le(hn::Load(d, low + k * lanes), v),
                   hn::Le(v, hn::Load(d, high + k * lanes)));
  };
  auto within = hn::Eq(hn::Zero(d), hn::Zero(d));
  std::size_t i = 0;
  for (; i + 3 * lanes <= count; i += 3 * lanes)
    within = hn::And(within, hn::And(in(i, 0), hn::And(in(i, 1), in(i, 2))));
  all_within = hn::AllTrue(d, within);
  return i;
}

}  // namespace HWY_NAMESPACE
}  // namespace delray::packs::internal
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace delray::packs::internal {
namespace {

HWY_EXPORT(look_at_most);

}  // namespace

bool are_within(const geometry::Box3& box, std::span<const glm::vec3> places) {
  const auto* const values = reinterpret_cast<const float*>(places.data());
  bool all = true;
  const std::size_t looked =
      HWY_DYNAMIC_DISPATCH(look_at_most)(box, values, 3 * places.size(), all);
  for (const glm::vec3& p : places.subspan(looked / 3)) {
    all = all && glm::all(glm::lessThanEqual(box.low, p)) &&
          glm::all(glm::lessThanEqual(p, box.high));
  }
  return all;
}

}  // namespace delray::packs::internal
#endif
