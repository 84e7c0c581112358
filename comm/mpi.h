// Ranks that are MPI processes.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <limits>
#include <memory>

#include "comm/communicator.h"
#include "parallel/progress.h"

namespace delray::comm {

// How messages travel between MPI processes, and how long a rank waits for one.
struct MpiOptions {
  // A rank that waits longer than this for one message ends all, with exit code 5 and a line that
  // names the rank that the wait is for in the end, and its phase where it runs on this machine.
  std::chrono::nanoseconds timeout = std::chrono::nanoseconds::max();
  // A message of this size or more travels in pieces of it, from 1 byte to 2^31 - 1.
  std::size_t piece_bytes = std::size_t{1} << 30;
  // Processes of one machine hand over messages of 64 KiB and more in memory that they share; only
  // where they are travels through MPI. Where the system does not let them, a process has too
  // little address space, or one of them does not want it, MPI copies as usual for all of that
  // machine.
  bool share_memory = true;
  // How many contexts an MPI communicator serves before a split makes another one, at most: MPI
  // itself allows some ten thousand or more.
  int most_contexts = std::numeric_limits<int>::max();
  // A rank that waits for a message throws parallel::Interrupted once this is asked to stop. May be
  // null.
  const parallel::Progress* progress = nullptr;
};

// Whether a launcher (mpirun, mpiexec, srun) started this process, as which rank (0 when none
// did), and of how many (1 where that is not known). From the environment: MPI need not be
// initialised.
bool launched_by_mpi();
int launched_rank();
int launched_size();

// Runs body(communicator) over MPI_COMM_WORLD. Initialises MPI (MPI_THREAD_SERIALIZED) unless
// somebody has, and finalises it if so; at most once in a process.
//
// An exception in one rank ends all: a line on stderr with rank, phase and reason, then MPI_Abort
// with exit code 5 (for errors of one rank alone that are nobody's fault: 3 for bad input, 2 for
// std::invalid_argument, 1 for a failing device and where there is no memory, 130 when interrupted:
// then rank 0, which may have something to save, ends the others as long as it does so within a
// minute). An exception that all ranks agreed on (comm/agree_on_failure.h) is rethrown on every
// rank after MPI was finalised. When the launcher ends this process (SIGTERM, as after the death of
// another rank), a line on stderr names the phase, before a handler that the program had installed
// is called.
void run_mpi(int* argc, char*** argv, const std::function<void(Communicator&)>& body,
             const MpiOptions& options = {});

// A communicator over the caller's: `mpi_communicator` is the address of an MPI_Comm, which is
// duplicated. Collective, and so is the destruction of the result. Its abort calls MPI_Abort(5).
// Throws std::invalid_argument for a piece_bytes that cannot be. REQUIRES: MPI is initialised with
// MPI_THREAD_FUNNELED or more and outlives the result.
std::unique_ptr<Communicator> make_mpi_communicator(const void* mpi_communicator,
                                                    const MpiOptions& options = {});

}  // namespace delray::comm
