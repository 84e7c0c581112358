// Recorded runs: whatever the text, a ledger that is written as it was read, or FileError.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "comm/ledger_file.h"
#include "files/error.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace delray;
  try {
    const comm::RecordedRun run =
        comm::parse_ledger({reinterpret_cast<const char*>(data), size}, "fuzz");
    const comm::RecordedRun again = comm::parse_ledger(comm::ledger_text(run), "fuzz");
    if (again.ledger.ranks.size() != run.ledger.ranks.size()) std::abort();
    for (std::size_t rank = 0; rank < run.ledger.ranks.size(); ++rank)
      if (again.ledger.ranks[rank].size() != run.ledger.ranks[rank].size()) std::abort();
  } catch (const files::FileError&) {
  }
  return 0;
}
