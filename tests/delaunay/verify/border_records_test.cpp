#include "delaunay/verify/border_records.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <mutex>
#include <random>
#include <vector>

#include "comm/threads.h"
#include "files/error.h"
#include "tests/support/temporary_folder.h"

namespace delray::delaunay::internal {
namespace {

struct Record {
  std::uint64_t key, from, number;
  auto operator<=>(const Record&) const = default;
};

// Whatever memory and ranks there are: all records, those of a key on one rank together, and of a
// rank in their order.
TEST(BorderRecords, GoToOneRankByTheirKeys) {
  const tests::TemporaryFolder folder;
  for (const int ranks : {1, 2, 3, 7, 70}) {
    for (const std::uint64_t memory : {0U, 500U, 1U << 30}) {
      std::vector<Record> given, got;
      std::mutex mutex;
      comm::run_threads(ranks, 1, [&](comm::Communicator& communicator) {
        BorderRecords<Record> records({memory, folder.path()});
        std::mt19937_64 random(static_cast<std::uint64_t>(communicator.rank()) + 1);
        const auto from = static_cast<std::uint64_t>(communicator.rank());
        for (std::uint64_t i = 0; i < 100 + 50 * (from % 3); ++i) {
          const Record record{random() % 200 * 0x9e3779b97f4a7c15U, from, i};
          records.add(record.key, record);
          const std::lock_guard lock(mutex);
          given.push_back(record);
        }
        std::vector<std::uint64_t> keys;
        int rounds = 0;
        records.exchange(
            communicator,
            [&](std::span<Record> some) {
              EXPECT_TRUE(std::ranges::is_sorted(some, {}, [](const Record& record) {
                return std::pair(record.from, record.number);
              }));
              const std::lock_guard lock(mutex);
              got.insert(got.end(), some.begin(), some.end());
            },
            [&] { ++rounds; });
        EXPECT_EQ(rounds, (64 + ranks - 1) / ranks);
      });
      std::ranges::sort(given);
      std::ranges::sort(got);
      EXPECT_EQ(given, got) << ranks << " ranks, " << memory << " bytes";
    }
  }
}

TEST(BorderRecords, NameTheFolderThatCannotBeWritten) {
  const tests::TemporaryFolder folder;
  BorderRecords<Record> records({0, folder.path() / "none"});
  EXPECT_THROW(records.add(1, {}), files::FileError);
}

}  // namespace
}  // namespace delray::delaunay::internal
