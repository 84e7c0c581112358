// Environment variables by which Open MPI chooses how messages travel within a machine.
#include "comm/mpi/open_mpi_choices.h"

#include <sys/uio.h>
#include <unistd.h>

#include <cstdlib>

namespace delray::comm::internal {
namespace {

int number_in(const char* variable) {
  const char* value = std::getenv(variable);
  return value == nullptr ? 0 : std::atoi(value);
}

void choose(const char* variable, const char* value) { setenv(variable, value, /*overwrite=*/0); }

bool copies_are_forbidden() {
  char source = 1, target = 0;
  iovec local{&target, 1}, remote{&source, 1};
  return process_vm_readv(getpid(), &local, 1, &remote, 1, 0) != 1;
}

bool is_on_one_machine() {
  const int here = number_in("OMPI_COMM_WORLD_LOCAL_SIZE");
  return here > 0 && here == number_in("OMPI_COMM_WORLD_SIZE");
}

}  // namespace

void choose_for_open_mpi() {
  if (copies_are_forbidden()) choose("OMPI_MCA_btl_vader_single_copy_mechanism", "none");
  if (is_on_one_machine() && std::getenv("OMPI_MCA_mtl") == nullptr) choose("OMPI_MCA_pml", "ob1");
}

}  // namespace delray::comm::internal
