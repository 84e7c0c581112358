// The tests of communicators over MPI: every process runs all tests, and the launcher fails when
// one of them does. Run it under mpirun with any number of processes.
#include <gtest/gtest.h>

#include <cstdio>

#include "comm/collectives.h"
#include "comm/mpi.h"
#include "comm/mpi/mpi_header.h"
#include "tests/comm/machine.h"

namespace delray::comm::testing {
namespace {

Communicator* world = nullptr;
Communicator* in_pieces = nullptr;  // messages in pieces of 1000 bytes

// The first `ranks` processes run the body; the others wait for them, so that tests do not overlap.
void run_on(Communicator& communicator, int ranks, const Body& body) {
  const bool takes_part = communicator.rank() < ranks;
  {
    const auto part = communicator.split(takes_part ? 0 : 1, 0);
    if (takes_part) body(*part);
  }
  barrier(communicator);
}

void run_whole(int ranks, const Body& body) { run_on(*world, ranks, body); }

void run_in_pieces(int ranks, const Body& body) { run_on(*in_pieces, ranks, body); }

// Says which process a failure is of.
class RankPrinter : public ::testing::EmptyTestEventListener {
  void OnTestPartResult(const ::testing::TestPartResult& result) override {
    if (!result.failed()) return;
    std::printf("rank %d: %s:%d: %s\n", world->rank(), result.file_name() ? result.file_name() : "",
                result.line_number(), result.message());
  }
};

}  // namespace

std::vector<Machine> machines() {
  int ranks = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  return {{"mpi", ranks, run_whole, run_whole}, {"mpi_in_pieces", ranks, run_in_pieces, run_whole}};
}

}  // namespace delray::comm::testing

int main(int argc, char** argv) {
  int failed = 0, provided = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
  ::testing::InitGoogleTest(&argc, argv);
  delray::comm::run_mpi(&argc, &argv, [&](delray::comm::Communicator& communicator) {
    const MPI_Comm all = MPI_COMM_WORLD;
    const auto in_pieces = delray::comm::make_mpi_communicator(&all, {.piece_bytes = 1000});
    delray::comm::testing::world = &communicator;
    delray::comm::testing::in_pieces = in_pieces.get();
    auto& listeners = ::testing::UnitTest::GetInstance()->listeners();
    if (communicator.rank() != 0) delete listeners.Release(listeners.default_result_printer());
    listeners.Append(new delray::comm::testing::RankPrinter);
    failed = RUN_ALL_TESTS();
  });
  MPI_Finalize();
  return failed;
}
