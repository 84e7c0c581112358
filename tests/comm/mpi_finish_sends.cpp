// A rank that has finished its sends may leave MPI alone: they arrive all the same.
#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <new>
#include <thread>

#include "comm/mpi.h"
#include "comm/mpi/mpi_header.h"

namespace delray::comm {
namespace {

// A counter in memory of all processes, which nobody needs MPI to look at.
class SharedCounter {
 public:
  SharedCounter() {
    int rank = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    const MPI_Aint bytes = rank == 0 ? sizeof(std::atomic<int>) : 0;
    MPI_Win_allocate_shared(bytes, 1, MPI_INFO_NULL, MPI_COMM_WORLD, &memory_, &window_);
    MPI_Aint size = 0;
    int unit = 0;
    MPI_Win_shared_query(window_, 0, &size, &unit, &memory_);
    if (rank == 0) new (memory_) std::atomic<int>(0);
    MPI_Barrier(MPI_COMM_WORLD);
  }
  ~SharedCounter() { MPI_Win_free(&window_); }
  SharedCounter(const SharedCounter&) = delete;
  SharedCounter& operator=(const SharedCounter&) = delete;
  std::atomic<int>& operator*() { return *static_cast<std::atomic<int>*>(memory_); }

 private:
  MPI_Win window_ = MPI_WIN_NULL;
  void* memory_ = nullptr;
};

// Large messages, which move only while their sender calls MPI, from rank 0 to all others, which
// send some among each other. Rank 0 then waits for the others outside of MPI.
TEST(MpiFinishSends, NobodyWaitsForTheSenderAfterwards) {
  constexpr std::size_t kBytes = std::size_t{3} << 20;
  const MPI_Comm all = MPI_COMM_WORLD;
  for (const std::size_t piece : {std::size_t{1} << 30, std::size_t{1} << 18}) {
    const auto world = make_mpi_communicator(&all, {.piece_bytes = piece, .share_memory = false});
    SharedCounter received;
    if (world->rank() == 0) {
      for (int to = 1; to < world->size(); ++to) world->send(to, 1, Buffer(kBytes));
      world->finish_sends();
      while (*received < world->size() - 1) std::this_thread::yield();
      continue;
    }
    const int others = world->size() - 1, next = world->rank() % others + 1;
    const int before = (world->rank() + others - 2) % others + 1;
    world->send(next, 2, Buffer(kBytes));
    EXPECT_EQ(world->receive(before, 2).size(), kBytes);
    EXPECT_EQ(world->receive(0, 1).size(), kBytes);
    world->finish_sends();
    ++*received;
  }
}

}  // namespace
}  // namespace delray::comm
