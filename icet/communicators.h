// Delray's communicators over those of the interface.
#pragma once

#include <memory>

#include "comm/communicator.h"
#include "icet/interface.h"

namespace delray::icet {

// The ranks of a communicator of the interface, which is duplicated: `given` may be destroyed
// before. Of one that icetCreateMPICommunicator made, Delray's own over MPI; of a program's own
// table of functions, make_program_communicator. Collective, and so is the destruction.
std::unique_ptr<comm::Communicator> make_ranks(IceTCommunicator given);

// Destroys what make_ranks made; where MPI is finalised already it is too late, and nothing is
// done.
void end_ranks(std::unique_ptr<comm::Communicator> ranks);

// Ranks that talk by the functions of a table that a program has filled: Duplicate, Destroy, Isend,
// Recv, Wait, Comm_rank and Comm_size are called. Each message is two of the table's: its tag and
// size, then its bytes. Receives name their source and tag, as those of compositing schemes and
// collectives do; probe, and ranks or tags that are any, are std::logic_error.
std::unique_ptr<comm::Communicator> make_program_communicator(IceTCommunicator given);

// The MPI_Comm that a communicator of icetCreateMPICommunicator has, as its address; null for those
// that others made.
const void* mpi_of(IceTCommunicator given);

}  // namespace delray::icet
