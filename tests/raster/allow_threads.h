// Threads for the tests of the rasterizer: more than the machine has cores.
#pragma once

#include "parallel/arena.h"

namespace delray::raster {

inline const parallel::AllowThreads kThreads(27);

}  // namespace delray::raster
