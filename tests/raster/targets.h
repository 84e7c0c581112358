// Runs a test on every instruction set that this machine has.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>

#include <hwy/highway.h>

namespace delray::raster {

// Calls f() once for each Highway target compiled in and supported, that target being chosen.
template <class F>
void for_each_target(F&& f) {
  const std::int64_t supported = hwy::SupportedTargets();
  for (std::int64_t rest = supported; rest != 0; rest &= rest - 1) {
    const std::int64_t target = rest & -rest;
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    SCOPED_TRACE(hwy::TargetName(target));
    f();
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

}  // namespace delray::raster
