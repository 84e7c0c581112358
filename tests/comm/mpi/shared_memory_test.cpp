// Shared memory that is out of reach, too large to map, or does not hold the message.
#include "comm/mpi/shared_memory.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace delray::comm::internal {
namespace {

// Before any memory is mapped.
TEST(SharedMemory, IsCopiedWhereThereIsTooLittleAddressSpace) {
  const SharedMemory mine = share_memory();
  if (mine.file < 0) GTEST_SKIP() << "no memory can be shared here";
  constexpr std::size_t kBytes = 300000;
  const std::vector<std::uint8_t> content(kBytes, 9);
  Buffer message = Buffer::of(std::span<const std::uint8_t>(content));
  const std::optional<std::uint64_t> place = lend(message);
  ASSERT_TRUE(place);
  const auto borrow_twice = [&] {
    const rlimit limit{std::size_t{1} << 29, RLIM_INFINITY};
    if (setrlimit(RLIMIT_AS, &limit) != 0) return 1;
    std::optional<Buffer> copy = borrow(mine, *place, kBytes);
    if (!copy || !std::ranges::equal(copy->as<std::uint8_t>(), content)) return 2;
    copy.reset();  // and goes back
    return borrow(mine, *place, kBytes) ? 3 : 0;
  };
  const pid_t child = fork();
  if (child == 0) _exit(borrow_twice());
  int status = -1;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
}

// One process of several was killed, and another has something to tell it for the first time.
TEST(SharedMemory, OfAProcessThatEndedIsOutOfReachAndNobodyIsRungFor) {
  const pid_t child = fork();
  if (child == 0) _exit(0);
  ASSERT_GT(child, 0);
  ASSERT_EQ(waitpid(child, nullptr, 0), child);
  const SharedMemory ended{child, 3, 0, 1};
  EXPECT_FALSE(can_reach(ended));
  EXPECT_FALSE(borrow(ended, 64, 1 << 20));
  EXPECT_FALSE(doing(ended));
  ring(ended);
}

// Of what another process may say, only a message that it has lent is read.
TEST(SharedMemory, PlacesThatHaveNoMessageAreRefused) {
  const SharedMemory mine = share_memory();
  if (mine.file < 0) GTEST_SKIP() << "no memory can be shared here";
  ASSERT_TRUE(can_reach(mine));
  constexpr std::size_t kBytes = 100000;
  const std::vector<std::uint8_t> content(kBytes, 7);
  Buffer message = Buffer::of(std::span<const std::uint8_t>(content));
  const std::optional<std::uint64_t> place = lend(message);
  ASSERT_TRUE(place);
  constexpr std::uint64_t kFar = std::numeric_limits<std::uint64_t>::max();
  for (const std::uint64_t wrong : {*place + 64, *place + 1, kFar, kFar - 63,
                                    std::uint64_t{1} << 28, (std::uint64_t{1} << 28) - 4096 - 64}) {
    EXPECT_FALSE(borrow(mine, wrong, kBytes)) << wrong;
  }
  for (const std::size_t wrong : {std::size_t{1} << 27, std::size_t{1} << 40, std::size_t{100},
                                  std::numeric_limits<std::size_t>::max()}) {
    EXPECT_FALSE(borrow(mine, *place, wrong)) << wrong;
  }
  const std::optional<Buffer> right = borrow(mine, *place, kBytes);
  ASSERT_TRUE(right);
  EXPECT_TRUE(std::ranges::equal(right->as<std::uint8_t>(), content));
}

}  // namespace
}  // namespace delray::comm::internal
