#include "comm/failure.h"

#include <utility>

namespace delray::comm {

RankFailure::RankFailure(int rank, Phase phase, std::string why, std::exception_ptr cause)
    : std::runtime_error("rank " + std::to_string(rank) + " failed in phase " + name(phase) + ": " +
                         why),
      rank_(rank),
      phase_(phase),
      why_(std::move(why)),
      cause_(std::move(cause)) {}

}  // namespace delray::comm
