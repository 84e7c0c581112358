// libdelray_record.so under a program of MPI that knows nothing of it.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "comm/ledger_file.h"
#include "comm/replay.h"

namespace delray::comm {
namespace {

TEST(MpiRecord, AnyProgramsMessagesBecomeALedgerThatCanBeReplayed) {
#ifdef DELRAY_SANITIZED
  GTEST_SKIP() << "a sanitizer wants to be loaded first";
#endif
  setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1);
  setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1);
  setenv("OMPI_MCA_rmaps_base_oversubscribe", "1", 1);
  setenv("OMPI_MCA_btl_vader_single_copy_mechanism", "none", 1);
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("delray_recorded_" + std::to_string(getpid()));
  constexpr int kRanks = 3;
  const std::string command =
      DELRAY_LIMIT " 60 " DELRAY_MPIEXEC " -n " + std::to_string(kRanks) +
      " -x LD_PRELOAD=" DELRAY_RECORD_LIBRARY " -x DELRAY_RECORD=" + file.string() +
      " " DELRAY_RECORDED_PROGRAM " 2>&1 < /dev/null";
  ASSERT_EQ(std::system(command.c_str()), 0);
  const RecordedRun run = read_ledger(file);
  std::filesystem::remove(file);
  EXPECT_NE(run.program.find("recorded_program"), std::string::npos);
  ASSERT_EQ(run.ledger.ranks.size(), std::size_t{kRanks});
  std::size_t passed = 0;
  for (std::size_t rank = 0; rank < kRanks; ++rank) {
    for (const Event& event : run.ledger.ranks[rank]) {
      if (event.kind != Event::Kind::send || event.tag >= kReservedTags) continue;
      // To the next rank, but for the one in the communicator that is the other way round.
      const bool is_next = event.peer == static_cast<int>((rank + 1) % kRanks);
      const bool is_before = event.peer == static_cast<int>((rank + 2) % kRanks);
      EXPECT_TRUE(event.tag == 9 ? is_next || is_before : is_next);
      EXPECT_EQ(event.amount, 4U);
      ++passed;
    }
  }
  // Tags 7, 8, 9 and 9 again; the two of the large tag are above those that are kept for
  // collectives.
  EXPECT_EQ(passed, 4U * kRanks);
  const Totals sum = totals(run.ledger);
  EXPECT_EQ(sum.messages_sent, sum.messages_received);
  EXPECT_EQ(sum.bytes_sent, sum.bytes_received);
  // 6 a rank; then of 3 ranks: barrier 6, broadcast 2, reduce 2, all-reduce 4, gathers and scatters
  // 2 each, all-gathers and all-to-alls 6 each, reduce-scatters 4 each, scans 2 each.
  EXPECT_EQ(sum.messages_sent, 6U * 3 + 6 + 2 + 2 + 4 + 4 * 2 + 4 * 6 + 2 * 4 + 2 * 2);
  for (const NamedNetwork& named : networks())
    EXPECT_GT(replay(run.ledger, named.network)[0], 0) << named.name;
  EXPECT_GT(replay(run.ledger, run.machine.network)[0], 0);
}

}  // namespace
}  // namespace delray::comm
