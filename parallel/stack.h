// Stacks of a stated size, whatever the limit of the process (ulimit -s) is.
#pragma once

#include <cstddef>

#include "parallel/function_ref.h"

namespace delray::parallel {

// What the deepest code needs, packets of rays with their shading, is a fraction of it; memory is
// taken for what is used only.
inline constexpr std::size_t kStackBytes = std::size_t{8} << 20;

// From now on threads of this process that say nothing else, and oneTBB's workers, have stacks of
// at least kStackBytes. oneTBB hears it only before it has started workers: call it first.
void set_stack_sizes();

// As above for oneTBB's workers alone, which whoever embeds Delray gets with its first Arena.
void set_worker_stack_size();

// What f() returns, called by a thread with a stack of at least kStackBytes, while the caller
// waits. Calls set_stack_sizes(). f must not throw.
int run_on_own_stack(FunctionRef<int()> f);

}  // namespace delray::parallel
