// raytrace/sampling/alias_table.h over lanes. Compiled once per instruction set.
#if defined(DELRAY_RAYTRACE_ALIAS_LANES) == defined(HWY_TARGET_TOGGLE)
#ifdef DELRAY_RAYTRACE_ALIAS_LANES
#undef DELRAY_RAYTRACE_ALIAS_LANES
#else
#define DELRAY_RAYTRACE_ALIAS_LANES
#endif

#include "raytrace/sampling/alias_table.h"
#include "shading/lanes.h"

HWY_BEFORE_NAMESPACE();
namespace delray::raytrace {
namespace HWY_NAMESPACE {

using namespace shading::HWY_NAMESPACE;

HWY_INLINE F looked_up(std::span<const float> table, I at) {
  return hn::GatherIndex(FloatTag(), table.data(), at);
}

// REQUIRES: 0 < table.size() < 2^22, so that every number can be picked.
HWY_INLINE I pick(const AliasTable& table, F column, F height) {
  const auto n = static_cast<std::int32_t>(table.size());
  const I i = hn::Min(truncated(column * set(static_cast<float>(n))), set(n - 1));
  const auto* aliases = reinterpret_cast<const std::int32_t*>(table.aliases().data());
  return hn::IfThenElse(hn::RebindMask(IntTag(), hn::Lt(height, looked_up(table.own(), i))), i,
                        hn::GatherIndex(IntTag(), aliases, i));
}

}  // namespace HWY_NAMESPACE
}  // namespace delray::raytrace
HWY_AFTER_NAMESPACE();

#endif
