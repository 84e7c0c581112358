#include "comm/internal/shared_memory.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

namespace delray::comm::internal {
namespace {

// One process of several was killed, and another has something to tell it for the first time.
TEST(SharedMemory, OfAProcessThatEndedIsOutOfReachAndNobodyIsRungFor) {
  const pid_t child = fork();
  if (child == 0) _exit(0);
  ASSERT_GT(child, 0);
  ASSERT_EQ(waitpid(child, nullptr, 0), child);
  const SharedMemory ended{child, 3, 0, 1};
  EXPECT_FALSE(can_reach(ended));
  ring(ended);
}

}  // namespace
}  // namespace delray::comm::internal
