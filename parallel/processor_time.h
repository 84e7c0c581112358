// Processor time of the calling thread. Waiting for a core does not count: threads that share cores
// are as busy as if each had its own.
#pragma once

#include <cstdint>
#include <optional>

namespace delray::parallel {

// Since the thread began. A call of the system: some 200 ns.
std::int64_t processor_nanoseconds();

// How long the calling thread has been ready, but without a core, since it began; nothing where the
// system does not tell. A call of the system: about a microsecond.
std::optional<std::int64_t> core_wait_nanoseconds();

// The same as the first for work in small pieces: some 30 ns. Asks the system only once in 0.2 ms,
// and takes the thread to have been at work in between: what it says is never less than before, and
// is wrong by 0.2 ms at most.
std::int64_t quick_processor_nanoseconds();

}  // namespace delray::parallel
