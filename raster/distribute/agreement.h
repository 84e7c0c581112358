// Whether ranks may go on from what they remember of a frame.
#pragma once

#include <cstdint>

#include "comm/communicator.h"

namespace delray::raster {

// One per rank. Ranks that were together in the last call that did not hold agree from then on,
// until one of them says that it does not remember, or one comes that was elsewhere.
class Agreement {
 public:
  // Whether all ranks agree and say that nothing has changed for them; if not, they agree anew, on
  // what they do after this call. Collective: 24 bytes are summed up over ranks.
  bool holds(comm::Communicator& communicator, bool is_unchanged);

 private:
  std::uint64_t name_ = 0;  // of the last call that did not hold: drawn at random; 0: none
};

}  // namespace delray::raster
