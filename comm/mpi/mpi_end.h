// The end of all ranks of an MPI run when one cannot go on, and the phase that it was in.
#pragma once

#include <string>

#include "comm/communicator.h"
#include "comm/mpi/mpi_header.h"

namespace delray::comm::internal {

// Writes "error: rank 2 failed in phase compose: why" to stderr and ends all ranks of
// `communicator`.
[[noreturn]] void end_all_ranks(MPI_Comm communicator, int rank, Phase phase,
                                const std::string& why, int exit_code);

// The phase that this process is in, for messages of the signal handler and of run_mpi.
void note_phase(Phase phase);
Phase noted_phase();

}  // namespace delray::comm::internal
