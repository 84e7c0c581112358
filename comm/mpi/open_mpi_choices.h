// What Open MPI is to be told before it begins, where its user has not.
#pragma once

namespace delray::comm::internal {

// Sets environment variables of Open MPI that are not set (OMPI_MCA_...); other MPIs know none of
// them. To be called before MPI_Init, by one thread.
//
// - Open MPI moves large messages between processes of one machine by process_vm_readv, believes
//   that it works wherever the kernel has it, and fails in containers that forbid it: it is told to
//   copy where that is so.
// - To choose how messages travel it opens the libraries of all networks that it was built for, of
//   which some wait a fifth of a second for devices that are not there. Processes that are all on
//   one machine have no use for a network: `ob1` has them exchange messages in its memory. That is
//   left alone where anything about it was chosen, or processes are on several machines.
void choose_for_open_mpi();

}  // namespace delray::comm::internal
