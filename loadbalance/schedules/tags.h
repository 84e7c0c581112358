// Tags of the messages of schedules.
#pragma once

#include "comm/communicator.h"

namespace delray::loadbalance::internal {

inline constexpr comm::Tag kTagRequest = 96;  // to a master
inline constexpr comm::Tag kTagTasks = 97;    // from a master
inline constexpr comm::Tag kTagSteal = 98;    // everything between ranks that steal

}  // namespace delray::loadbalance::internal
