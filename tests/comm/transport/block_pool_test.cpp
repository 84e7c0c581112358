// Blocks of shared memory that are lent, and those of the heap that follow.
#include "comm/transport/block_pool.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <set>
#include <vector>

namespace delray::comm::internal {
namespace {

constexpr std::size_t kBlockBytes = 100'000;
constexpr std::int64_t kProcess = 7;

struct alignas(64) Line {
  std::byte bytes[64];
};

class SharedBlocks : public ::testing::Test {
 protected:
  SharedBlocks() {
    pool_.share(kProcess, std::as_writable_bytes(std::span(lines_)));
    other_.share(kProcess + 1, std::as_writable_bytes(std::span(other_lines_)));
  }

  std::vector<Line> lines_{16'384}, other_lines_{64};  // 1 MiB, 4 KiB
  BlockPool pool_, other_;
};

TEST_F(SharedBlocks, AreNotUsedAgainBeforeTheyAreBack) {
  Block* const lent = pool_.take(kBlockBytes);
  ASSERT_TRUE(pool_.is_shared(*lent));
  const std::size_t place = pool_.lend(lent);
  EXPECT_EQ(static_cast<void*>(reinterpret_cast<std::byte*>(lines_.data()) + place), lent);
  Block* const next = pool_.take(kBlockBytes);
  EXPECT_NE(next, lent);
  EXPECT_FALSE(other_.is_shared(*lent));
  EXPECT_EQ(pool_.lent(), 1U);
  other_.give_back(lent);
  EXPECT_EQ(pool_.lent(), 0U);
  EXPECT_EQ(pool_.take(kBlockBytes), lent);
  pool_.give_back(next);
  EXPECT_EQ(pool_.take(kBlockBytes), next);
}

TEST_F(SharedBlocks, AreFollowedByThoseOfTheHeap) {
  std::set<Block*> shared;
  Block* block = pool_.take(kBlockBytes);
  for (; pool_.is_shared(*block); block = pool_.take(kBlockBytes)) shared.insert(block);
  EXPECT_GE(shared.size(), 8U);
  EXPECT_LE(shared.size(), 10U);
  std::fill_n(block->memory(), kBlockBytes, std::byte{1});
  pool_.give_back(block);
  pool_.give_back(*shared.begin());
  EXPECT_EQ(pool_.take(kBlockBytes), *shared.begin());
}

}  // namespace
}  // namespace delray::comm::internal
