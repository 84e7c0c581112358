// Messages that make no sense: from a rank of another build, or damaged on their way.
#pragma once

#include <stdexcept>

namespace delray::comm {

// Ends the run as any exception of a rank does. Ranks trust each other (see SECURITY.md), so that
// sizes and counts are checked, which memory depends on, but not all that a number may stand for.
struct BadMessage : std::runtime_error {
  using std::runtime_error::runtime_error;
};

inline void check_message(bool fine) {
  if (!fine) throw BadMessage("received a message that makes no sense");
}

}  // namespace delray::comm
