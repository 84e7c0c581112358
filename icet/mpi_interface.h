// The part of IceT's interface that needs MPI.
#pragma once

#include <mpi.h>

#include "icet/interface.h"

#ifdef __cplusplus
extern "C" {
#endif

#pragma GCC visibility push(default)
IceTCommunicator icetCreateMPICommunicator(MPI_Comm mpi_comm);
void icetDestroyMPICommunicator(IceTCommunicator communicator);
#pragma GCC visibility pop

#ifdef __cplusplus
}
#endif
