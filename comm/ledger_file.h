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
  // Cores of rank 0's machine that other programs took meanwhile, on the average; negative where
  // that is not known. They make the run longer, and a replay does not know of them.
  double other_programs = -1;
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

// The machine on which the ledger was recorded, by what its own messages took. Where the recording
// asked for the time of the processor (Event::processor), a byte takes the mean of messages of 64
// KiB and more, and what is left of all of them is shared out evenly: together messages take the
// processor as long as they did, what a rank does while it waits for one included, which cores that
// ranks share do not do for others meanwhile. Else it is the clock's time of sends, of which most
// wait for nobody: the lower quartile of those of at most 4 KiB, and of those of 64 KiB and more
// for a byte. Both are 0 where there was none. Messages do not compete for links, and ranks take
// turns on `cores` cores if they are fewer. O(events).
NamedNetwork machine_of(const Ledger& ledger, int cores);

}  // namespace delray::comm
