// A recording lasts from MPI_Init to MPI_Finalize. The ledger goes to the file that the environment
// variable DELRAY_RECORD names, else to ledger.json.
#include <cstdlib>

#include "comm/mpi_record/journal.h"

namespace delray::comm::mpi_record {
namespace {

void forget(MPI_Comm communicator) {
  const std::lock_guard lock(journal().mutex());
  journal().forget(communicator);
}

}  // namespace
}  // namespace delray::comm::mpi_record

using namespace delray::comm::mpi_record;

extern "C" {

int MPI_Init(int* argc, char*** argv) {
  const int result = PMPI_Init(argc, argv);
  journal().start();
  return result;
}
int MPI_Init_thread(int* argc, char*** argv, int required, int* provided) {
  const int result = PMPI_Init_thread(argc, argv, required, provided);
  journal().start();
  return result;
}
int MPI_Finalize() {
  const char* file = std::getenv("DELRAY_RECORD");
  journal().finish(file != nullptr && *file != '\0' ? file : "ledger.json");
  return PMPI_Finalize();
}
int MPI_Comm_free(MPI_Comm* communicator) {
  forget(*communicator);
  return PMPI_Comm_free(communicator);
}
int MPI_Comm_disconnect(MPI_Comm* communicator) {
  forget(*communicator);
  return PMPI_Comm_disconnect(communicator);
}

}  // extern "C"
