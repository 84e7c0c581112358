// The number of something that is not there.
#pragma once

#include <cstdint>

namespace delray::scenes {

inline constexpr std::uint32_t kNone = 0xFFFFFFFFU;

}  // namespace delray::scenes
