// Ledgers of whole runs as files, for `delray replay` (docs/networks.md).
#pragma once

#include <string>

#include "comm/ledger.h"
#include "comm/network.h"

namespace delray::comm {

// What was recorded of a run, on every rank from its first event to its last.
struct RecordedRun {
  std::string program;   // its command line
  double seconds = 0;    // from when all ranks had begun until the last was done
  NamedNetwork machine;  // that it ran on, as its messages tell: machine_of()
  Ledger ledger;
};

// JSON of schema delray.ledger/1, one line for each rank; times in whole nanoseconds. Any bytes of
// `program` that are no UTF-8 are replaced. O(events).
std::string ledger_text(const RecordedRun& run);

// Reads that text. Throws files::FileError (input) that names the line of what is no JSON, or the
// key or rank and event: what is unknown, out of range, or is received but never sent. `file` is
// what errors call it. Time and memory in proportion to the text.
RecordedRun parse_ledger(std::string_view text, const std::string& file);
RecordedRun read_ledger(const std::string& file);

// The machine on which the ledger was recorded, by how long its own calls took: the processor's
// share of a message is the lower quartile of all sends of at most 4 KiB, its time for a byte that
// of sends of 64 KiB and more; both are 0 where there was none. Most sends wait for nobody, so that
// how long the run took does not go into it; those that lost their core or waited lie above the
// quartile. Messages do not compete for links, and ranks take turns on `cores` cores if they are
// fewer. O(events).
NamedNetwork machine_of(const Ledger& ledger, int cores);

}  // namespace delray::comm
