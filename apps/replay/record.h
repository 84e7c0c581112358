// --record: what ranks sent, received and worked, written down for `delray replay`.
#pragma once

#include <functional>
#include <string>

#include "comm/communicator.h"

namespace delray::apps {

// How a run is written down.
struct RecordOptions {
  std::string file;       // the ledger
  std::string program;    // its command line
  bool has_cores = true;  // each thread of a rank has a core for itself
};

// Runs body(communicator) on this rank and records it; rank 0 writes the ledger, whole or not at
// all, when all are done. What a rank does between messages is recorded as the time that passes,
// or, where threads share cores, as the processor time of the rank's own thread. Collective. Throws
// what `body` throws, before anything is written, and files::FileError.
void run_recorded(comm::Communicator& communicator, const RecordOptions& options,
                  const std::function<void(comm::Communicator&)>& body);

}  // namespace delray::apps
