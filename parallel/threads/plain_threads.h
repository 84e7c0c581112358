// Loops over std::thread instead of oneTBB, for ThreadSanitizer: it sees these threads start and
// join, but not what orders the tasks of a oneTBB that was built without it, and so would report
// races that there are not and overlook others. Threads are made anew for every loop.
#pragma once

#include <cstddef>

#include "parallel/function_ref.h"

namespace delray::parallel::internal {

// Calls f(task) for every task of [0, tasks), the caller's thread among as many as its arena has.
// Rethrows what one of them threw first; tasks that had not begun are then left out.
void run_on_plain_threads(std::size_t tasks, FunctionRef<void(std::size_t task)> f);

}  // namespace delray::parallel::internal
